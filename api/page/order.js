// The experiment's form: presets, validation while typing, start and stop.
import { get, post } from "./server.js";
import { sparkline } from "./chart.js";
import { el, fixed, short } from "./format.js";

const form = document.getElementById("order"), verdict = document.getElementById("verdict");
const startButton = document.getElementById("start"), stopButton = document.getElementById("stop");
const hindrances = { tripped: "Reset first", disconnected: "Not connected", connecting: "Connecting" };
let presets = [], chosen = null, valid = false, asked = 0, timer = 0, running = null, hindrance = "";

export async function prepareOrder(onProblem) {
  form.addEventListener("input", (event) => { if (event.target.name !== "comment" && event.target.name !== "model") choose(null); later(); });
  form.addEventListener("submit", (event) => { event.preventDefault(); begin(onProblem); });
  stopButton.addEventListener("click", () => running && post(`/experiments/${running}/stop`).catch(onProblem));
  presets = await get("/situations");
  document.getElementById("situations").replaceChildren(...presets.map((preset) =>
    el("button", { type: "button", "aria-pressed": "false", "data-name": preset.name, title: describe(preset), onclick: () => apply(preset) }, preset.name)));
  fillModels().catch(onProblem);
  if (presets.length) apply(presets.find((preset) => preset.name === "2") || presets[0]); else check();
}

// The fibre models, and the extended models that diagnoses of runs have found.
async function fillModels() {
  const [models, runs] = await Promise.all([get("/models"), get("/runs")]);
  const extended = runs.filter((run) => run.links.model).map((run) => el("option", { value: run.name }, `extended by ${run.name}`));
  document.getElementById("model").replaceChildren(
    ...models.map((m) => el("option", { value: m.name, title: m.title, selected: m.name === "force" }, m.name)), ...extended);
}

function describe(p) {
  return `${p.shape}, ${p.frequency} Hz, ${short(1e3 * p.amplitude)} mm${p.added_mass ? ", added mass" : ""}`;
}

function choose(name) {
  chosen = name;
  for (const button of document.querySelectorAll("#situations button")) button.setAttribute("aria-pressed", button.dataset.name === name);
}

function apply(preset) {
  const fields = form.elements;
  fields.shape.value = preset.shape; fields.frequency.value = preset.frequency; fields.amplitude.value = short(1e3 * preset.amplitude, 6);
  fields.ramp.value = preset.ramp || ""; fields.cycles.value = preset.cycles; fields.added_mass.checked = preset.added_mass > 0;
  choose(preset.name);
  check();
}

export function order() {
  const fields = form.elements, number = (name) => (fields[name].value === "" ? null : Number(fields[name].value));
  const stroke = number("amplitude");
  return {
    shape: fields.shape.value, frequency: number("frequency"), amplitude: stroke === null ? null : stroke / 1e3,
    ramp: fields.shape.value === "trapezoidal" ? number("ramp") : null, cycles: number("cycles"),
    added_mass: fields.added_mass.checked, situation: chosen, comment: fields.comment.value, model: fields.model.value || "force",
  };
}

function later() { clearTimeout(timer); timer = setTimeout(check, 180); }

async function check() {
  document.getElementById("ramp-field").hidden = form.elements.shape.value !== "trapezoidal";
  const turn = ++asked;
  try {
    const answer = await post("/experiments/validate", order());
    if (turn === asked) show(answer.errors, answer.plan);
  } catch (problem) {
    if (turn === asked) show(problem.errors?.length ? problem.errors : [{ field: "", message: problem.message }], null);
  }
}

function show(errors, plan) {
  valid = errors.length === 0;
  for (const input of form.querySelectorAll("input, select")) input.removeAttribute("aria-invalid");
  for (const { field } of errors) form.elements[field]?.setAttribute?.("aria-invalid", "true");
  verdict.classList.toggle("bad", !valid);
  verdict.replaceChildren();
  if (!valid) verdict.append(el("ul", {}, ...errors.map((e) => el("li", {}, e.field ? `${e.field}: ${e.message}` : e.message))));
  if (plan) showPlan(plan);
  buttons();
}

function showPlan(plan) {
  const canvas = el("canvas", { role: "img", "aria-label": "Planned drive motion, two cycles" });
  const rows = plan.limits.flatMap(({ name, value, limit, unit, scale }) => [
    el("span", { class: "muted" }, name),
    el("meter", { min: 0, max: limit, low: 0.8 * limit, high: 0.95 * limit, optimum: 0, value: Math.min(value, limit), "aria-label": `${name} of its limit` }),
    el("span", { class: "num" }, `${short(value * scale)} / ${short(limit * scale)} ${unit}`),
  ]);
  verdict.append(canvas, el("p", {}, `${fixed(plan.seconds, 1, "s")} with rest before and after, within the limits:`), el("div", { class: "limits" }, ...rows));
  requestAnimationFrame(() => sparkline(canvas, plan.preview.t, plan.preview.x));
}

async function begin(onProblem) {
  if (!valid || running) return;
  startButton.disabled = true;
  try { await post("/experiments", order()); } catch (problem) { onProblem(problem); } finally { buttons(); }
}

export function setReady(condition) { hindrance = hindrances[condition] || ""; buttons(); }

export function setRunning(identity) { running = identity; buttons(); }

function buttons() {
  startButton.disabled = !valid || Boolean(running) || Boolean(hindrance);
  stopButton.disabled = !running;
  startButton.textContent = running ? "Running" : hindrance || "Start";
}

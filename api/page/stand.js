// The stand's devices and its preparation.
import { post } from "./server.js";
import { el, facts as factsLine, fixed, short } from "./format.js";

const list = document.getElementById("device-list"), result = document.getElementById("preparation-result");
const buttons = document.querySelectorAll("#preparation button");
const tones = { ok: "ok", running: "ok", ready: "ok", idle: "ok", stale: "warn", unknown: "warn", lost: "bad", fault: "bad", tripped: "bad", disconnected: "bad" };

export function prepareStand(onProblem) {
  for (const button of buttons) button.addEventListener("click", () => act(button, onProblem));
}

async function act(button, onProblem) {
  const jog = button.dataset.jog;
  const path = jog ? "/stand/jog" : `/stand/${button.dataset.do}`;
  const body = jog ? { distance: (Number(jog) * Number(document.getElementById("jog-step").value)) / 1e3 } : {};
  result.textContent = `${button.textContent.trim()} …`;
  try { result.textContent = (await post(path, body)).message; } catch (problem) { result.textContent = ""; onProblem(problem); }
}

export function allowPreparation(allowed) { for (const button of buttons) button.disabled = !allowed; }

export function showStand(stand) {
  document.getElementById("reset").hidden = stand.state !== "tripped";
  list.replaceChildren(...stand.devices.map(device));
}

function device({ title, state, detail, rate, clock, latency, lost, age, fields }) {
  const facts = Object.entries(fields || {});
  if (rate) facts.push(["rate", fixed(rate, rate < 100 ? 1 : 0, "Hz")]);
  if (clock) facts.push(["clock", `${clock.drift_ppm >= 0 ? "+" : "−"}${short(Math.abs(clock.drift_ppm), 2)} ppm`], ["residual", `${short(clock.residual_us, 2)} µs`]);
  if (latency !== null && latency !== undefined) facts.push(["latency", fixed(1e3 * latency, 2, "ms")]);
  if (lost) facts.push(["frames lost", String(lost)]);
  if (age !== null && age !== undefined && age > 0.5) facts.push(["last sample", `${fixed(age, 1, "s")} ago`]);
  return el("div", { class: "device" }, el("h3", {}, title, el("span", { class: `state ${tones[state] || ""}` }, state)),
    detail ? el("p", { class: "small muted" }, detail) : null, facts.length ? factsLine(facts) : null);
}

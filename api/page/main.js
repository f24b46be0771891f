// The page's wiring: messages of the live stream to the parts, and the state of it all told plainly.
import { post } from "./server.js";
import { Live } from "./live.js";
import { clearCharts, prepareCharts, pushBlock, redraw } from "./charts.js";
import { prepareOrder, setReady, setRunning } from "./order.js";
import { allowPreparation, prepareStand, showStand } from "./stand.js";
import { allowNext as allow, refreshRuns, showJob } from "./runs.js";
import { showScores } from "./scores.js";
import { el, fixed } from "./format.js";

const at = (id) => document.getElementById(id);
const ACTIVE = new Set(["starting", "running", "stopping"]);
const tones = { idle: "ok", ready: "ok", moving: "busy", connecting: "busy", tripped: "bad", disconnected: "bad", unknown: "warn" };
const state = { connected: false, retry: 0, experiment: null, stand: null, lastBlock: 0, dropped: 0, latency: null, problem: null, seen: null, dismissed: null };

const onProblem = (problem) => { state.problem = problem; tell(); };

new Live({
  connected() { state.connected = true; state.problem = null; refreshRuns(onProblem); tell(); },
  disconnected(retry) { state.connected = false; state.retry = retry; tell(); },
  stand(message) { state.stand = message; showStand(message); setReady(message.state); allowNext(); tell(); },
  experiment(message) { experiment(message); },
  block(message) { block(message); },
  job(message) { showJob(message, onProblem); },
  runs() { refreshRuns(onProblem); },
  dropped(message) { state.dropped = message.blocks; tell(); },
});

function experiment(message) {
  if (message.id !== state.seen) { clearCharts(); showScores(null); state.seen = message.id; state.dropped = 0; }
  state.experiment = message;
  state.lastBlock = performance.now();
  setRunning(ACTIVE.has(message.state) ? message.id : null);
  allowNext();
  at("twin-name").textContent = message.model;
  at("progress").value = message.progress;
  at("phases").replaceChildren(...message.phases.map(({ name, state: when }) =>
    el("li", { class: when, "aria-current": when === "now" ? "step" : null }, name)));
  tell();
}

function block(message) {
  if (message.experiment !== state.seen) return;
  state.lastBlock = performance.now();
  if (message.latency !== undefined) state.latency = message.latency;
  pushBlock(message);
  if (message.score) showScores(message.score);
}

function pill(element, text, tone) {
  if (element.textContent !== text) element.textContent = text;
  element.className = `pill ${tone}`;
}

function allowNext() { allow(!active() && state.stand?.state === "ready"); }

function active() { return state.experiment && ACTIVE.has(state.experiment.state); }
function stale() { return active() && state.experiment.streaming && performance.now() - state.lastBlock > 1000; }

function tell() {
  const stand = state.stand, run = active();
  at("stand-name").textContent = stand ? stand.name : "connecting";
  const condition = !state.connected ? "unknown" : stand?.state || "connecting";
  pill(at("stand-pill"), `stand ${condition}`, tones[condition] || "");
  const age = (performance.now() - state.lastBlock) / 1000;
  if (!state.connected) pill(at("link-pill"), "server lost", "bad");
  else if (stale()) pill(at("link-pill"), `no data for ${fixed(age, 0, "s")}`, "warn");
  else if (run && state.latency !== null) pill(at("link-pill"), `live, ${fixed(1e3 * state.latency, 0, "ms")} behind${state.dropped ? `, ${state.dropped} blocks dropped` : ""}`, "ok");
  else pill(at("link-pill"), run ? "waiting for samples" : "connected", "ok");
  allowPreparation(state.connected && !run);
  at("emergency").disabled = !state.connected;
  banner();
}

function banner() {
  const run = state.experiment, key = `${run?.id}${run?.state}`;
  if (!state.connected) return show("bad", "The server does not answer.", `What is shown is old. A running experiment goes on; its limits and the guardian still hold. Trying again every ${fixed(state.retry / 1000, 1, "s")}.`);
  if (stale()) return show("bad", "No samples are coming.", "The stand's watchdog stops the drive when data go stale. What is shown is old.");
  if (state.problem) return show("bad", state.problem.title || "That did not work.", state.problem.message, () => { state.problem = null; });
  if (run && state.dismissed !== key && (run.state === "tripped" || run.state === "failed" || run.state === "emergency-stopped"))
    return show("bad", run.state === "failed" ? "The experiment failed." : run.state === "tripped" ? "The stand was tripped and is stopped." : "Emergency stop: the stand is stopped.",
      `${run.why ? `${run.why.replace(/\.$/, "")}. ` : ""}Nothing resumes by itself.`, () => { state.dismissed = key; });
  if (run?.note && run.state === "running") return show("warn", "The run goes on without its twin.", run.note);
  if (state.stand?.state === "tripped" && !active()) return show("warn", "The stand stays stopped until it is reset.", `${state.stand.message ? `${state.stand.message}. ` : ""}See to the cause first; the reset is below, under Stand.`);
  if (state.stand?.state === "disconnected") return show("warn", "The stand can't be reached.", state.stand.message || "");
  at("banner").hidden = true;
}

function show(tone, title, text, dismiss) {
  const place = at("banner"), key = `${tone}${title}${text}`;
  if (place.dataset.key !== key || place.hidden) {
    place.dataset.key = key; place.className = tone; place.hidden = false;
    place.replaceChildren(el("div", {}, el("strong", {}, title), text), dismiss ? el("button", { type: "button", onclick: () => { dismiss(); tell(); } }, "Understood") : "");
  }
}

function emergency() { post("/emergency-stop").catch(onProblem); }

at("emergency").addEventListener("click", emergency);
document.addEventListener("keydown", (event) => { if (event.key === "Escape" && !event.repeat) { event.preventDefault(); emergency(); } });
at("theme").addEventListener("click", () => {
  const dark = getComputedStyle(document.documentElement).colorScheme === "dark";
  localStorage.setItem("theme", document.documentElement.dataset.theme = dark ? "light" : "dark");
  redraw();
});
if (localStorage.getItem("theme")) document.documentElement.dataset.theme = localStorage.getItem("theme");
setInterval(tell, 500);
prepareCharts();
prepareStand(onProblem);
showScores(null);
prepareOrder(onProblem).catch(onProblem);

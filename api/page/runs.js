// The list of runs with what was computed beside them, and the jobs that are computing.
import { get, post } from "./server.js";
import { clock, correlation, dash, el, fixed, short } from "./format.js";

const body = document.querySelector("#run-list tbody"), jobs = document.getElementById("jobs");
const known = new Map();
let pending = 0, mayStart = false;

// Whether the stand is free for the experiment that a diagnosis proposes.
export function allowNext(allowed) {
  mayStart = allowed;
  for (const button of body.querySelectorAll("button.next")) button.disabled = !allowed;
}

export function refreshRuns(onProblem) {
  clearTimeout(pending);
  pending = setTimeout(async () => {
    try { show(await get("/runs"), onProblem); } catch (problem) { onProblem(problem); }
  }, 60);
}

function show(runs, onProblem) {
  body.replaceChildren(...runs.map((run) => row(run, onProblem)));
  if (!runs.length) body.append(el("tr", {}, el("td", { colspan: 9, class: "muted" }, "No run yet: start an experiment above.")));
}

function row(run, onProblem) {
  const u = run.scores?.weight_position, F = run.scores?.fibre_force;
  return el("tr", {}, el("td", {}, clock(run.written)), el("td", {}, excitation(run)), el("td", { class: "num" }, fixed(run.seconds, 1, "s")),
    el("td", { class: "num" }, correlation(u?.R)), el("td", { class: "num" }, correlation(F?.R)), el("td", { class: "num" }, correlation(F?.R_ceiling)),
    el("td", {}, state(run)), el("td", {}, verdict(run)), results(run, onProblem));
}

function excitation(run) {
  if (!run.readable) return run.name;
  if (!run.shape) return run.name;
  return `${run.shape} ${short(run.frequency)} Hz, ${short(1e3 * run.amplitude)} mm${run.added_mass ? `, +${short(run.added_mass, 4)} kg` : ""}`;
}

function state(run) {
  if (!run.readable) return el("span", { class: "state bad", title: run.why }, "unreadable");
  if (run.complete === false) return el("span", { class: "state warn", title: "Not closed: stand doctor --recover redoes it" }, "not closed");
  return el("span", { class: "state ok" }, run.complete ? "complete" : dash);
}

function verdict({ verdict: found }) {
  if (!found) return dash;
  const words = [...found.causes, ...(found.unknown ? ["something unknown"] : [])];
  return words.length ? el("strong", {}, words.join(", ")) : "as calibrated";
}

function results(run, onProblem) {
  const link = (href, text) => href && el("a", { href, target: "_blank", rel: "noopener" }, text);
  const ask = (text, path, payload) => el("button", { type: "button", onclick: () => post(path, payload).catch(onProblem) }, text);
  return el("td", {}, link(run.links["comparison-page"], "report") || (run.readable ? ask("compare", `/runs/${run.name}/comparison`) : null),
    link(run.links["diagnosis-page"], "diagnosis") || (run.readable ? ask("diagnose", "/diagnoses", { runs: [run.name] }) : null),
    run.verdict?.next ? next(run, onProblem) : null,
    el("a", { href: run.links.file, download: `${run.name}.h5` }, "HDF5"));
}

function next(run, onProblem) {
  const button = el("button", { type: "button", class: "next", title: run.verdict.next }, "run the next experiment");
  button.disabled = !mayStart;
  button.addEventListener("click", () => { button.disabled = true; post(`/runs/${run.name}/next-experiment`).catch(onProblem); });
  return button;
}

export function showJob(job, onProblem) {
  known.set(job.id, job);
  const busy = [...known.values()].filter((each) => each.state === "running" || each.state === "queued");
  const failed = job.state === "failed" ? `${job.kind} failed: ${job.error}` : "";
  jobs.textContent = busy.map((each) => `${each.kind} ${each.state}${each.what ? `: ${each.what}` : ""}${each.fraction ? ` ${Math.round(100 * each.fraction)} %` : ""}`).join(" · ") || failed;
  if (job.state === "done" || job.state === "failed") refreshRuns(onProblem);
}

// R(p), NRMSE, lag and the short-window error beside them.
import { correlation, definitions, el, fixed, short } from "./format.js";

const place = document.getElementById("scores");
const channels = [["u", "R(u) weight position"], ["F", "R(F) fibre force"]];

export function showScores(score) {
  place.replaceChildren(...channels.map(([key, title]) => card(title, score?.[key], score?.short?.[key], key)));
}

function card(title, run, window, key) {
  const unit = key === "u" ? ["µm", 1e6] : ["N", 1];
  return el("div", { class: "score", id: `score-${key}` }, el("h3", { class: "muted" }, title),
    el("div", { class: "big" }, el("output", { class: "value", "aria-label": title }, correlation(run?.R)), el("span", { class: "muted small" }, "whole run")),
    definitions([["sliding window", correlation(run?.sliding_R)], ["NRMSE", fixed(run?.nrmse && 100 * run.nrmse, 2, "%")],
      ["lag", fixed(run?.lag_s && 1e3 * run.lag_s, 2, "ms")],
      ["short-window error", window === null || window === undefined ? "–" : `${short(window * unit[1])} ${unit[0]}`]]));
}

// The three strips, fed by blocks, drawn at the screen's pace.
import { Strip } from "./chart.js";
import { fixed, millimetres } from "./format.js";

const measured = (name) => ({ name, colour: "--measured", weight: 2.6 });
const simulated = (name) => ({ name, colour: "--simulated", weight: 1.25 });
const at = (id) => document.getElementById(id);

const strips = {
  u: new Strip(at("chart-u"), { series: [measured("u"), simulated("u_sim")], scale: 1e3, least: 0.002 }),
  F: new Strip(at("chart-F"), { series: [measured("F"), simulated("F_sim")], scale: 1, least: 5 }),
  x: new Strip(at("chart-x"), { series: [measured("x")], scale: 1e3, least: 0.002 }),
};
let dirty = true, frozen = false, now = {};

export function prepareCharts() {
  at("window").addEventListener("change", (event) => { for (const strip of all()) strip.seconds = Number(event.target.value); dirty = true; });
  at("freeze").addEventListener("click", (event) => {
    frozen = !frozen; dirty = true;
    event.target.setAttribute("aria-pressed", frozen); event.target.textContent = frozen ? "Go on" : "Freeze";
  });
  requestAnimationFrame(paint);
}

const all = () => Object.values(strips);

export function clearCharts() { all().forEach((strip) => strip.clear()); dirty = true; }

export function pushBlock(block) {
  for (const strip of all()) strip.push(block);
  const last = (pair) => (pair?.[1]?.length ? (pair[0].at(-1) + pair[1].at(-1)) / 2 : null);
  if (block.t) now = { u: last(block.u), F: last(block.F), x: last(block.x) };
  dirty = true;
}

export function redraw() { dirty = true; }

function paint() {
  if (dirty && !frozen && !document.hidden) {
    all().forEach((strip) => strip.draw());
    at("now-u").textContent = millimetres(now.u); at("now-x").textContent = millimetres(now.x); at("now-F").textContent = fixed(now.F, 1, "N");
    dirty = false;
  }
  requestAnimationFrame(paint);
}

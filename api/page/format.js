// Numbers and texts as the operator reads them.

export const dash = "–";

export function fixed(value, digits, unit = "") {
  return value === null || value === undefined || Number.isNaN(value) ? dash : `${value.toFixed(digits)}${unit && ` ${unit}`}`;
}

export function short(value, digits = 3) {
  if (value === null || value === undefined) return dash;
  return Number(value.toPrecision(digits)).toString();
}

export const correlation = (value) => fixed(value, Math.abs(value) > 0.99 ? 5 : 4);
export const millimetres = (value, digits = 2) => fixed(value === null || value === undefined ? value : 1e3 * value, digits, "mm");

export function clock(iso) {
  const at = new Date(iso);
  return `${at.toLocaleDateString()} ${at.toLocaleTimeString()}`;
}

// el("p", {class: "small"}, "text", child): an element with attributes and children; text is never parsed as HTML.
export function el(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== undefined && value !== null && value !== false) made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined && child !== ""));
  return made;
}

// Facts in a line, as many as fit.
export const facts = (pairs) => el("dl", { class: "facts" }, ...pairs.map(([term, value]) => el("div", {}, el("dt", {}, term), el("dd", {}, value))));

export const definitions = (pairs) =>
  el("dl", {}, ...pairs.flatMap(([term, value]) => [el("dt", {}, term), el("dd", {}, value)]));

(function () {
  "use strict";
  var root = document.documentElement, plots = [];
  function ink(name) { return getComputedStyle(root).getPropertyValue("--" + name).trim(); }
  function themed(trace) {
    var copy = Object.assign({}, trace), colour = copy.role ? ink(copy.role) : null;
    delete copy.role;
    if (!colour) return copy;
    if (copy.fill) { copy.fillcolor = ink("band"); copy.line = Object.assign({}, copy.line, { color: "rgba(0,0,0,0)" }); return copy; }
    if ((copy.mode || "lines").indexOf("lines") >= 0) copy.line = Object.assign({ width: 1.4 }, copy.line, { color: colour });
    if ((copy.mode || "").indexOf("markers") >= 0 || copy.type === "bar") copy.marker = Object.assign({}, copy.marker, { color: colour });
    if (copy.error_y) copy.error_y = Object.assign({}, copy.error_y, { color: colour });
    return copy;
  }
  function layout(given) {
    var made = JSON.parse(JSON.stringify(given)), axis = { gridcolor: ink("grid"), zerolinecolor: ink("line"), linecolor: ink("line"),
      tickfont: { color: ink("soft"), size: 12 }, ticks: "outside", tickcolor: ink("line"), automargin: true };
    Object.keys(made).forEach(function (key) {
      if (!/^[xy]axis/.test(key)) return;
      var title = made[key].title;
      made[key] = Object.assign({}, axis, made[key]);
      if (title) made[key].title = { text: title.text || title, font: { color: ink("soft"), size: 13 }, standoff: 8 };
    });
    (made.shapes || []).forEach(function (shape) { if (shape.role) { shape.line = Object.assign({ width: 1, dash: "dot" }, shape.line, { color: ink(shape.role) }); delete shape.role; } });
    (made.annotations || []).forEach(function (note) { note.font = Object.assign({ size: 12 }, note.font, { color: ink(note.role || "soft") }); delete note.role; });
    return Object.assign({ paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: ink("ink"), family: "inherit" },
      margin: { l: 64, r: 16, t: 28, b: 44 }, hovermode: "closest", dragmode: "zoom",
      legend: { orientation: "h", x: 0, y: 1.02, yanchor: "bottom", font: { color: ink("ink"), size: 13 } },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: ink("soft"), activecolor: ink("accent") }, hoverlabel: { bgcolor: ink("card"), bordercolor: ink("line"), font: { color: ink("ink") } } }, made);
  }
  function draw(node) {
    var figure = JSON.parse(node.querySelector("script").textContent), target = node.querySelector(".plot");
    plots.push({ target: target, figure: figure });
    return Plotly.newPlot(target, figure.data.map(themed), layout(figure.layout), { responsive: true, displaylogo: false,
      modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] });
  }
  function redraw() { plots.forEach(function (p) { Plotly.react(p.target, p.figure.data.map(themed), layout(p.figure.layout)); }); }
  function theme(name, keep) {
    root.dataset.theme = name;
    var button = document.querySelector("button.theme");
    if (button) button.textContent = name === "dark" ? "Light" : "Dark";
    if (keep) { try { localStorage.setItem("theme", name); } catch (_) { /* a page from disk may not store */ } }
    redraw();
  }
  var stored = null;
  try { stored = localStorage.getItem("theme"); } catch (_) { /* as above */ }
  var dark = window.matchMedia("(prefers-color-scheme: dark)"), chosen = stored;
  theme(stored || (dark.matches ? "dark" : "light"), false);
  dark.addEventListener("change", function (event) { if (!chosen) theme(event.matches ? "dark" : "light", false); });
  document.querySelectorAll("figure.chart").forEach(draw);
  document.querySelectorAll("details").forEach(function (fold) {
    fold.addEventListener("toggle", function () { if (fold.open) fold.querySelectorAll(".plot").forEach(function (p) { Plotly.Plots.resize(p); }); });
  });
  var button = document.querySelector("button.theme");
  if (button) button.addEventListener("click", function () { chosen = root.dataset.theme === "dark" ? "light" : "dark"; theme(chosen, true); });
  var before = null;
  window.addEventListener("beforeprint", function () { before = root.dataset.theme; theme("light", false); });
  window.addEventListener("afterprint", function () { if (before) theme(before, false); });
})();

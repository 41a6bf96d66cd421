"use strict";
// Curves as SVG: over an angle, or around the point of incidence.

const svgSpace = "http://www.w3.org/2000/svg";

function svgElement(name, attributes, text) {
  const element = document.createElementNS(svgSpace, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

/** Round numbers between two limits, about so many. */
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= raw);
  const list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; i += 1) list.push(i * step);
  return list;
}

/** How values become heights between 0 and 1, and where its axis is marked. */
function heights(values, scale) {
  const usable = values.filter((value) => Number.isFinite(value));
  const top = Math.max(...usable, 0);
  const bottom = Math.min(...usable, 0);
  if (scale === "log") {
    const high = top > 0 ? Math.ceil(Math.log10(top)) : 0;
    const low = high - 5;
    const marks = [];
    for (let power = low; power <= high; power += 1) marks.push(10 ** power);
    return { place: (value) => (value > 0 ? Math.max(0, (Math.log10(value) - low) / (high - low)) : 0), marks };
  }
  if (scale === "cbrt") {
    const low = Math.cbrt(bottom);
    const high = Math.cbrt(top) || 1;
    const marks = ticks(low, high, 5).map((root) => root ** 3);
    return { place: (value) => (Math.cbrt(value) - low) / (high - low), marks };
  }
  const high = top > bottom ? top : bottom + 1;
  return { place: (value) => (value - bottom) / (high - bottom), marks: ticks(bottom, high, 5) };
}

function pathOf(points) {
  let path = "";
  let isDrawing = false;
  for (const [x, y] of points) {
    if (!Number.isFinite(x) || !Number.isFinite(y)) {
      isDrawing = false;
      continue;
    }
    path += `${isDrawing ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`;
    isDrawing = true;
  }
  return path;
}

const shownValues = (one) => one.y.concat((one.dots ?? []).map((dot) => dot.y));

/**
 * Draws curves over an angle.
 * @param series [{name, colour, dash, x, y, error, dots: [{x, y, deviation}]}]
 * @param options {label, xLabel, yLabel, from, to, scale, unit: behind numbers of x, line: a height to mark, onPoint(x)}
 */
function drawChart(box, series, options) {
  const width = Math.max(300, box.clientWidth);
  const height = Math.min(380, Math.max(220, width * 0.42));
  const edge = { left: 58, right: 12, top: 10, bottom: 36 };
  const inner = { width: width - edge.left - edge.right, height: height - edge.top - edge.bottom };
  const svg = svgElement("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": options.label });
  const all = series.flatMap(shownValues).concat(options.line === undefined ? [] : [options.line]);
  const { place, marks } = heights(all, options.scale);
  const x = (angle) => edge.left + ((angle - options.from) / (options.to - options.from)) * inner.width;
  const y = (value) => edge.top + (1 - place(value)) * inner.height;
  for (const mark of marks) {
    svg.append(svgElement("line", { class: "grid", x1: edge.left, x2: width - edge.right, y1: y(mark), y2: y(mark) }));
    svg.append(svgElement("text", { x: edge.left - 6, y: y(mark) + 4, "text-anchor": "end" }, general(mark, 3)));
  }
  for (const mark of ticks(options.from, options.to, width < 500 ? 4 : 9)) {
    svg.append(svgElement("line", { class: "grid", x1: x(mark), x2: x(mark), y1: edge.top, y2: height - edge.bottom }));
    svg.append(svgElement("text", { x: x(mark), y: height - edge.bottom + 15, "text-anchor": "middle" }, `${general(mark, 4)}${options.unit ?? "°"}`));
  }
  svg.append(svgElement("text", { x: edge.left + inner.width / 2, y: height - 4, "text-anchor": "middle" }, options.xLabel));
  svg.append(svgElement("text", { x: 12, y: edge.top + inner.height / 2, "text-anchor": "middle",
    transform: `rotate(-90 12 ${edge.top + inner.height / 2})` }, options.yLabel));
  if (options.line !== undefined) {
    svg.append(svgElement("line", { class: "one", x1: edge.left, x2: width - edge.right, y1: y(options.line), y2: y(options.line) }));
  }
  for (const one of series) {
    const band = one.x.map((angle, i) => [x(angle), y(one.y[i] + (one.error[i] || 0))]);
    const lower = one.x.map((angle, i) => [x(angle), y(one.y[i] - (one.error[i] || 0))]).reverse();
    svg.append(svgElement("path", { d: pathOf(band.concat(lower)), fill: one.colour, "fill-opacity": 0.25, stroke: "none" }));
    svg.append(svgElement("path", { d: pathOf(one.x.map((angle, i) => [x(angle), y(one.y[i])])), fill: "none",
      stroke: one.colour, "stroke-width": 2, "stroke-dasharray": one.dash ?? "none" }));
    for (const dot of one.dots ?? []) {
      if (dot.deviation > 0) {
        svg.append(svgElement("line", { stroke: one.colour, x1: x(dot.x), x2: x(dot.x), y1: y(dot.y - dot.deviation),
          y2: y(dot.y + dot.deviation) }));
      }
      svg.append(svgElement("circle", { class: "dot", fill: one.colour, cx: x(dot.x), cy: y(dot.y), r: 3 }));
    }
  }
  if (options.onPoint) {
    svg.addEventListener("pointermove", (event) => {
      const at = svg.getBoundingClientRect();
      const angle = options.from + (((event.clientX - at.left) / at.width) * width - edge.left) / inner.width * (options.to - options.from);
      if (angle >= options.from && angle <= options.to) options.onPoint(angle);
    });
  }
  box.replaceChildren(svg);
}

/** Draws curves as distances from the point of incidence; `light` is the angle of incidence. */
function drawPolar(box, series, options) {
  const width = Math.max(300, Math.min(box.clientWidth, 900));
  const radius = width / 2 - 24;
  const height = radius + 40;
  const centre = { x: width / 2, y: radius + 14 };
  const svg = svgElement("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": options.label });
  const { place, marks } = heights(series.flatMap(shownValues), options.scale);
  const at = (angle, distance) => [centre.x + Math.sin((angle * Math.PI) / 180) * distance * radius,
    centre.y - Math.cos((angle * Math.PI) / 180) * distance * radius];
  for (const mark of marks) {
    const size = place(mark) * radius;
    if (!(size > 0)) continue;
    svg.append(svgElement("path", { class: "grid", fill: "none",
      d: `M${centre.x - size} ${centre.y}A${size} ${size} 0 0 1 ${centre.x + size} ${centre.y}` }));
    svg.append(svgElement("text", { x: centre.x + size, y: centre.y + 14, "text-anchor": "middle" }, general(mark, 2)));
  }
  for (const angle of [-60, -30, 0, 30, 60]) {
    const [x, y] = at(angle, 1);
    svg.append(svgElement("line", { class: "grid", x1: centre.x, y1: centre.y, x2: x, y2: y }));
  }
  svg.append(svgElement("line", { class: "axis", x1: centre.x - radius, x2: centre.x + radius, y1: centre.y, y2: centre.y }));
  const [lightX, lightY] = at(-options.light, 1);
  svg.append(svgElement("line", { class: "one", x1: lightX, y1: lightY, x2: centre.x, y2: centre.y }));
  svg.append(svgElement("text", { x: lightX, y: lightY - 4, "text-anchor": "middle" }, "light"));
  for (const one of series) {
    svg.append(svgElement("path", { d: pathOf(one.x.map((angle, i) => at(angle, place(one.y[i])))), fill: "none",
      stroke: one.colour, "stroke-width": 2, "stroke-dasharray": one.dash ?? "none" }));
    for (const dot of one.dots ?? []) {
      const [x, y] = at(dot.x, place(dot.y));
      svg.append(svgElement("circle", { class: "dot", fill: one.colour, cx: x, cy: y, r: 3 }));
    }
  }
  box.replaceChildren(svg);
}

/** A file that the browser saves. */
function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** A picture with the colours that it has on the page. */
function saveSvg(box, name) {
  const svg = box.querySelector("svg");
  if (svg === null) return;
  const copy = svg.cloneNode(true);
  const marks = [...svg.querySelectorAll("*")];
  [...copy.querySelectorAll("*")].forEach((element, i) => {
    const style = getComputedStyle(marks[i]);
    element.setAttribute("stroke", style.stroke);
    element.setAttribute("fill", style.fill);
    if (style.strokeDasharray !== "none") element.setAttribute("stroke-dasharray", style.strokeDasharray);
  });
  copy.setAttribute("xmlns", svgSpace);
  copy.setAttribute("font-family", "sans-serif");
  copy.setAttribute("font-size", "11");
  save(name, new XMLSerializer().serializeToString(copy), "image/svg+xml");
}

/** A row per point of each curve. */
function csvOf(series, xName, yName) {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const lines = [`material,${xName},${yName},error`];
  for (const one of series) one.x.forEach((x, i) => lines.push(`${quoted(one.name)},${x},${one.y[i]},${one.error[i]}`));
  return `${lines.join("\n")}\n`;
}

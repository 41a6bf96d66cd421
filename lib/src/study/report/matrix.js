"use strict";
// The matrix of distances, on two canvases: cells below, and above what follows the pointer.

class Matrix {
  constructor(actions) {
    this.actions = actions;
    this.cells = document.getElementById("cells");
    this.marks = document.getElementById("marks");
    this.row = 0;
    this.column = 0;
    this.hasCursor = false;
    this.marks.addEventListener("pointermove", (event) => this.point(event));
    this.marks.addEventListener("pointerleave", () => this.leave());
    this.marks.addEventListener("click", (event) => {
      this.point(event);
      this.choose();
    });
    this.marks.addEventListener("keydown", (event) => this.press(event));
    this.marks.addEventListener("blur", () => this.leave());
  }

  draw(state) {
    this.state = state;
    this.measure = study.measures[state.measure];
    this.sequence = state.order === "tree" ? this.measure.leaf_order : d3.range(study.materials.length);
    this.arrange();
    this.paintCells();
    this.paintLabels();
    this.paintMarks();
    this.drawKey();
  }

  /** Sizes: labels of materials where rows are high enough for them, else of families. */
  arrange() {
    const width = this.cells.parentElement.clientWidth;
    const count = this.sequence.length;
    const highest = Math.max(0.8 * window.innerHeight, 320);
    this.strip = 8;
    const sizeBeside = (labels) => Math.min(width - labels - this.strip - 1, highest);
    const ofMaterials = this.labelWidth(study.materials.map((material) => material.name), width, width / count);
    let labels = 0;
    this.labels = "none";
    if (width >= 520 && sizeBeside(ofMaterials) / count >= 8) {
      this.labels = "materials";
      labels = ofMaterials;
    } else if (width >= 520 && this.state.order === "file") {
      this.labels = "families";
      labels = this.labelWidth(study.families, width, Infinity);
    }
    this.left = labels + this.strip + 1;
    this.top = this.strip + 1;
    this.size = sizeBeside(labels);
    this.cell = this.size / count;
    for (const canvas of [this.cells, this.marks]) {
      canvas.style.width = `${this.left + this.size}px`;
      canvas.style.height = `${this.top + this.size}px`;
      canvas.width = Math.round((this.left + this.size) * devicePixelRatio);
      canvas.height = Math.round((this.top + this.size) * devicePixelRatio);
      canvas.getContext("2d").setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    }
  }

  /** Of the longest name, in rows of such a height; at most a good quarter of the whole. */
  labelWidth(names, width, height) {
    const context = this.cells.getContext("2d");
    context.font = this.font(this.labelSize(height));
    return Math.min(d3.max(names, (name) => context.measureText(name).width) + 8, 0.28 * width);
  }

  labelSize(height) {
    return Math.max(6, Math.min(12, height - 0.5));
  }

  font(size) {
    return `${size}px system-ui, "DejaVu Sans", sans-serif`;
  }

  /** One pixel per cell, then enlarged. */
  paintCells() {
    const count = this.sequence.length;
    const share = this.measure.shares(this.state.scale);
    const palette = d3.range(256).map((level) => d3.rgb(d3.interpolateViridis(level / 255)));
    const missing = d3.rgb(themeColour("--missing"));
    const image = new ImageData(count, count);
    for (let row = 0; row < count; ++row) {
      for (let column = 0; column < count; ++column) {
        const value = this.measure.value(this.sequence[row], this.sequence[column]);
        const isShown = Number.isFinite(value);
        const level = value > 0 ? Math.round(255 * share(value)) : 0;
        const colour = isShown ? palette[level] : missing;
        image.data.set([colour.r, colour.g, colour.b, 255], 4 * (row * count + column));
      }
    }
    const small = document.createElement("canvas");
    small.width = count;
    small.height = count;
    small.getContext("2d").putImageData(image, 0, 0);
    const context = this.cells.getContext("2d");
    context.clearRect(0, 0, this.left + this.size, this.top + this.size);
    context.imageSmoothingEnabled = count * 1.5 > this.size * devicePixelRatio;
    context.drawImage(small, this.left, this.top, this.size, this.size);
  }

  paintLabels() {
    const context = this.cells.getContext("2d");
    this.sequence.forEach((material, row) => {
      context.fillStyle = familyColour(study.materials[material].family);
      context.fillRect(this.left - this.strip - 1, this.top + row * this.cell, this.strip, this.cell + 0.5);
      context.fillRect(this.left + row * this.cell, 0, this.cell + 0.5, this.strip);
    });
    context.fillStyle = themeColour("--ink");
    context.textAlign = "right";
    context.textBaseline = "middle";
    const room = this.left - this.strip - 5;
    const write = (text, y) => context.fillText(shortened(context, text, room), room, y);
    if (this.labels === "materials") {
      context.font = this.font(this.labelSize(this.cell));
      const middle = (row) => this.top + (row + 0.5) * this.cell;
      this.sequence.forEach((material, row) => write(study.materials[material].name, middle(row)));
    } else if (this.labels === "families") {
      context.font = this.font(12);
      let written = -Infinity;
      for (const {family, from, to} of this.blocks()) {
        const y = this.top + ((from + to) / 2) * this.cell;
        if (y - written < 13) continue;
        write(study.families[family], y);
        written = y;
      }
    }
  }

  /** Rows that follow each other and are of one family. */
  blocks() {
    const blocks = [];
    this.sequence.forEach((material, row) => {
      const {family} = study.materials[material];
      const last = blocks[blocks.length - 1];
      if (last && last.family === family) last.to = row + 1;
      else blocks.push({family, from: row, to: row + 1});
    });
    return blocks;
  }

  paintMarks() {
    const context = this.marks.getContext("2d");
    context.clearRect(0, 0, this.left + this.size, this.top + this.size);
    const place = (at) => at * this.cell;
    const thickness = Math.max(this.cell, 1.5);
    if (this.state.matches.size > 0) {
      context.strokeStyle = themeColour("--accent");
      context.fillStyle = themeColour("--accent");
      this.sequence.forEach((material, row) => {
        if (!this.state.matches.has(material)) return;
        context.globalAlpha = 0.22;
        context.fillRect(this.left, this.top + place(row), this.size, thickness);
        context.fillRect(this.left + place(row), this.top, thickness, this.size);
        context.globalAlpha = 1;
        context.fillRect(this.left - this.strip - 1, this.top + place(row), this.strip, thickness);
        context.fillRect(this.left + place(row), 0, thickness, this.strip);
      });
    }
    const frame = (row, column, colour, width) => {
      context.lineWidth = width;
      context.strokeStyle = colour;
      const size = Math.max(this.cell, 6);
      const corner = (at) => (at + 0.5) * this.cell - size / 2;
      context.strokeRect(this.left + corner(column), this.top + corner(row), size, size);
    };
    const first = this.sequence.indexOf(this.state.first);
    const second = this.sequence.indexOf(this.state.second);
    for (const [row, column] of [[first, second], [second, first]]) {
      frame(row, column, "#ffffff", 4);
      frame(row, column, "#c4161c", 2);
    }
    if (!this.hasCursor) return;
    context.globalAlpha = 0.75;
    context.fillStyle = "#ffffff";
    context.fillRect(this.left, this.top + (this.row + 0.5) * this.cell - 0.5, this.size, 1);
    context.fillRect(this.left + (this.column + 0.5) * this.cell - 0.5, this.top, 1, this.size);
    context.globalAlpha = 1;
    frame(this.row, this.column, "#000000", 3);
    frame(this.row, this.column, "#ffffff", 1.5);
  }

  /** The colours' distances. */
  drawKey() {
    const box = document.getElementById("colour-key");
    box.replaceChildren();
    const width = Math.min(this.left + this.size, 460);
    const svg = d3.select(box).append("svg").attr("width", width).attr("height", 40)
      .attr("role", "img").attr("aria-label", "Colours of distances");
    const margin = 22;
    const scale = this.measure.shares(this.state.scale).copy().range([margin, width - margin]);
    const gradient = svg.append("linearGradient").attr("id", "viridis");
    for (const share of d3.range(0, 1.01, 0.05)) {
      gradient.append("stop").attr("offset", share).attr("stop-color", d3.interpolateViridis(share));
    }
    svg.append("rect").attr("x", margin).attr("y", 6).attr("width", width - 2 * margin).attr("height", 10)
      .attr("fill", "url(#viridis)");
    const axis = d3.axisBottom(scale).tickSize(4);
    if (this.state.scale === "log") axis.tickValues(logTicks(scale, 44)).tickFormat((value) => general(value, 2));
    else axis.ticks(5).tickFormat((value) => general(value, 4));
    svg.append("g").attr("transform", "translate(0,16)").call(axis);
  }

  point(event) {
    const box = this.marks.getBoundingClientRect();
    const at = (offset) => Math.floor(offset / this.cell);
    const row = at(event.clientY - box.top - this.top);
    const column = at(event.clientX - box.left - this.left);
    const isInside = (index) => index >= 0 && index < this.sequence.length;
    if (!isInside(row) || !isInside(column)) return this.leave();
    this.moveTo(row, column);
    const [first, second] = this.pair();
    return this.actions.showTip(event.clientX, event.clientY, pairLines(this.measure, first, second));
  }

  leave() {
    this.hasCursor = false;
    this.paintMarks();
    this.actions.hideTip();
  }

  press(event) {
    const step = event.shiftKey ? 10 : 1;
    const moves = {ArrowUp: [-step, 0], ArrowDown: [step, 0], ArrowLeft: [0, -step], ArrowRight: [0, step]};
    if (event.key === "Enter" || event.key === " ") {
      this.choose();
    } else if (event.key in moves) {
      const last = this.sequence.length - 1;
      const [down, right] = moves[event.key];
      this.moveTo(Math.min(last, Math.max(0, this.row + down)), Math.min(last, Math.max(0, this.column + right)));
    } else {
      return;
    }
    event.preventDefault();
  }

  moveTo(row, column) {
    this.row = row;
    this.column = column;
    this.hasCursor = true;
    this.paintMarks();
    document.getElementById("cell").textContent = pairLines(this.measure, ...this.pair()).join(" · ");
  }

  pair() {
    return [this.sequence[this.row], this.sequence[this.column]];
  }

  choose() {
    const [first, second] = this.pair();
    if (first !== second) this.actions.choose(first, second);
  }
}

/** What a cell says. */
function pairLines(measure, first, second) {
  const {materials} = study;
  if (first === second) return [materials[first].name, `size ${measure.normText(first)}`];
  return [materials[first].name, materials[second].name, measure.text(first, second)];
}

/** Ticks of a logarithmic scale that stand so many pixels apart: decades, with 2 and 5 where there is room. */
function logTicks(scale, distance) {
  const [low, high] = scale.domain();
  const exponents = d3.range(Math.floor(Math.log10(low)), Math.ceil(Math.log10(high)) + 1);
  const candidates = [[1], [5], [2]].map((digits) => exponents.flatMap((e) => digits.map((digit) => digit * 10 ** e)));
  const ticks = [];
  for (const value of candidates.flat()) {
    const isInside = value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9);
    if (isInside && ticks.every((tick) => Math.abs(scale(tick) - scale(value)) >= distance)) ticks.push(value);
  }
  return ticks.sort((a, b) => a - b);
}

"use strict";
// The tree of the materials: average linkage, leaves in their optimal order.

const leafHeight = 15;

class Tree {
  constructor(actions) {
    this.actions = actions;
    this.svg = d3.select("#tree-picture");
  }

  draw(state) {
    const measure = study.measures[state.measure];
    const count = study.materials.length;
    this.svg.selectAll("*").remove();
    const note = document.getElementById("tree-note");
    if (measure.merges.length === 0) {
      note.textContent = "A single material has no tree.";
      return;
    }
    note.textContent = `Heights are mean distances between clusters${measure.unitText && `, in${measure.unitText}`}` +
      (state.scale === "log" ? ", logarithmic." : ".");
    const width = this.svg.node().parentElement.clientWidth - 4;
    const labelRoom = Math.min(210, 0.42 * width);
    const top = 22;
    this.svg.attr("width", width).attr("height", top + count * leafHeight + 4)
      .attr("role", "img").attr("aria-label", "Tree of the materials");

    const x = this.heights(measure, state.scale).range([width - labelRoom, 10]);
    const y = new Map(measure.leaf_order.map((material, row) => [material, top + (row + 0.5) * leafHeight]));
    const axis = d3.axisTop(x).tickSize(4);
    if (state.scale === "log") axis.tickValues(logTicks(x, 44)).tickFormat((value) => general(value, 2));
    else axis.ticks(Math.max(2, Math.floor((width - labelRoom) / 60))).tickFormat((value) => general(value, 4));
    this.svg.append("g").attr("transform", `translate(0,${top - 2})`).call(axis);
    this.drawMerges(measure, x, y, count);
    this.drawLeaves(state, y, width, labelRoom);
  }

  /** From 0, or from the lowest merge that a logarithm knows. */
  heights(measure, scale) {
    const heights = measure.merges.map((merge) => merge[2]).filter((height) => height > 0);
    const highest = d3.max(heights) || 1;
    if (scale === "log" && heights.length > 0) {
      return d3.scaleLog().domain([0.8 * d3.min(heights), highest]).clamp(true);
    }
    return d3.scaleLinear().domain([0, highest]);
  }

  drawMerges(measure, x, y, count) {
    const at = (cluster) => (cluster < count ? x.range()[0] : x(measure.merges[cluster - count][2]));
    const merges = measure.merges.map(([first, second, height, error, size], index) => {
      y.set(count + index, (y.get(first) + y.get(second)) / 2);
      const end = height > 0 ? x(height) : x.range()[0];
      const path = `M${at(first)},${y.get(first)}H${end}V${y.get(second)}H${at(second)}`;
      return {path, text: [counted(size, "material"), `height ${estimateText(height, error)}${measure.unitText}`]};
    });
    this.svg.append("g").attr("fill", "none").selectAll("path").data(merges).join("path")
      .attr("d", (merge) => merge.path)
      .attr("stroke", themeColour("--faint")).attr("stroke-width", 1.2)
      .on("pointermove", (merge) => this.actions.showTip(d3.event.clientX, d3.event.clientY, merge.text))
      .on("pointerleave", () => this.actions.hideTip());
  }

  drawLeaves(state, y, width, labelRoom) {
    const context = document.createElement("canvas").getContext("2d");
    context.font = '11px system-ui, "DejaVu Sans", sans-serif';
    const leaves = this.svg.append("g").selectAll("g").data(study.measures[state.measure].leaf_order).join("g")
      .attr("class", "leaf")
      .attr("transform", (material) => `translate(${width - labelRoom + 8},${y.get(material)})`)
      .style("cursor", "pointer")
      .on("click", (material) => this.actions.chooseNext(material))
      .on("pointermove", (m) => this.actions.showTip(d3.event.clientX, d3.event.clientY, materialLines(m)))
      .on("pointerleave", () => this.actions.hideTip());
    leaves.append("rect").attr("x", -6).attr("y", -leafHeight / 2)
      .attr("width", labelRoom).attr("height", leafHeight)
      .attr("fill", (material) => (state.matches.has(material) ? themeColour("--accent") : "transparent"))
      .attr("fill-opacity", 0.25);
    leaves.append("path").attr("d", (material) => familySymbol(study.materials[material].family, 36))
      .attr("fill", (material) => familyColour(study.materials[material].family));
    leaves.append("text").attr("x", 8).attr("dy", "0.35em")
      .attr("font-weight", (material) => (isChosen(state, material) ? 700 : 400))
      .text((material) => shortened(context, study.materials[material].name, labelRoom - 20));
  }
}

/** The text, or its beginning where there is no room for all. */
function shortened(context, text, room) {
  if (context.measureText(text).width <= room) return text;
  let length = text.length;
  while (length > 1 && context.measureText(`${text.slice(0, length)}…`).width > room) --length;
  return `${text.slice(0, length)}…`;
}

/** What a material says of itself, its name first: family, file, and where the study has it. */
function materialLines(material) {
  const {name, file, origin} = study.materials[material];
  return [name, file === null ? familyOf(material) : `${familyOf(material)}: ${file}`].concat(origin ?? []);
}

function isChosen(state, material) {
  return material === state.first || material === state.second;
}

"use strict";
// The map: materials as points, by classical scaling of their distances. Both axes have one scale.

class MaterialMap {
  constructor(actions) {
    this.actions = actions;
    this.svg = d3.select("#map-picture");
    this.transform = d3.zoomIdentity;
    // The page scrolls with the wheel; with Ctrl, or two fingers, the map grows.
    this.zoom = d3.zoom().scaleExtent([0.8, 5000])
      .filter(() => !d3.event.button && (d3.event.type !== "wheel" || d3.event.ctrlKey))
      .on("zoom", () => {
        this.transform = d3.event.transform;
        this.place();
      });
    this.svg.call(this.zoom);
    document.getElementById("map-all").addEventListener("click", () => this.show(d3.range(this.points.length)));
    document.getElementById("map-core").addEventListener("click", () => this.show(this.core()));
  }

  draw(state) {
    this.state = state;
    const {map} = study.measures[state.measure];
    this.points = map.points;
    this.width = this.svg.node().parentElement.clientWidth - 26;
    this.height = Math.min(0.75 * this.width, 520);
    this.svg.selectAll("*").remove();
    this.svg.attr("width", this.width).attr("height", this.height)
      .attr("role", "img").attr("aria-label", "Map of the materials");
    this.scale(d3.range(this.points.length));
    this.axes = this.svg.append("g");
    this.marks = this.svg.append("g");
    this.labels = this.svg.append("g").attr("pointer-events", "none");
    this.marks.selectAll("path").data(d3.range(this.points.length)).join("path")
      .attr("class", "material")
      .attr("d", (m) => familySymbol(study.materials[m].family, isChosen(state, m) ? 170 : 64))
      .attr("fill", (material) => familyColour(study.materials[material].family))
      .attr("stroke", (material) => this.edge(material)).attr("stroke-width", 1.5)
      .attr("fill-opacity", (material) => (state.matches.size === 0 || state.matches.has(material) ? 0.9 : 0.25))
      .style("cursor", "pointer")
      .on("click", (material) => this.actions.chooseNext(material))
      .on("pointermove", (m) => this.actions.showTip(d3.event.clientX, d3.event.clientY, materialLines(m)))
      .on("pointerleave", () => this.actions.hideTip());
    const share = general(100 * map.explained_share, 3);
    document.getElementById("map-note").textContent =
      `The two axes show ${share} % of the squared distances from the centre. Drag to move, Ctrl and the wheel or ` +
      "two fingers to zoom; a click chooses a material in place of the one that was chosen first.";
    this.place();
  }

  edge(material) {
    return isChosen(this.state, material) || this.state.matches.has(material)
      ? themeColour("--accent") : themeColour("--panel");
  }

  /** Scales that show these materials, before zooming. */
  scale(materials) {
    const margin = 34;
    const extent = [0, 1].map((axis) => d3.extent(materials, (material) => this.points[material][axis]));
    const spans = extent.map(([low, high]) => high - low);
    const [across, up] = [this.width - 2 * margin, this.height - 2 * margin];
    const unit = Math.max(spans[0] / across, spans[1] / up) || 1;
    const middle = extent.map(([low, high]) => (low + high) / 2);
    const domain = (axis, pixels) => [middle[axis] - (unit * pixels) / 2, middle[axis] + (unit * pixels) / 2];
    this.x = d3.scaleLinear(domain(0, this.width), [0, this.width]);
    this.y = d3.scaleLinear(domain(1, this.height), [this.height, 0]);
  }

  show(materials) {
    this.scale(materials);
    this.svg.call(this.zoom.transform, d3.zoomIdentity);
    this.place();
  }

  /** The four fifths that lie nearest to the median point. */
  core() {
    const median = [0, 1].map((axis) => d3.median(this.points, (point) => point[axis]));
    const distance = (material) => Math.hypot(...[0, 1].map((axis) => this.points[material][axis] - median[axis]));
    const all = d3.range(this.points.length).sort((a, b) => distance(a) - distance(b));
    return all.slice(0, Math.max(2, Math.floor(0.8 * all.length)));
  }

  place() {
    const x = this.transform.rescaleX(this.x);
    const y = this.transform.rescaleY(this.y);
    this.axes.selectAll("*").remove();
    const format = (value) => general(value, 3);
    this.axes.append("g").attr("transform", `translate(0,${this.height - 18})`)
      .call(d3.axisBottom(x).ticks(6).tickSize(-this.height).tickFormat(format));
    this.axes.append("g").attr("transform", "translate(0,0)")
      .call(d3.axisRight(y).ticks(5).tickSize(this.width).tickFormat(format))
      .call((axis) => axis.selectAll("text").attr("x", 2).attr("dy", -3));
    this.axes.selectAll(".domain").remove();
    this.axes.selectAll(".tick line").attr("stroke", themeColour("--grid"));
    const at = (material) => [x(this.points[material][0]), y(this.points[material][1])];
    this.marks.selectAll("path").attr("transform", (material) => `translate(${at(material)})`);
    this.placeLabels(at);
  }

  /** Names of what is chosen or found, and of medoids, where they do not cover each other. */
  placeLabels(at) {
    const {medoids = []} = study.measures[this.state.measure];
    const wanted = [this.state.first, this.state.second, ...this.state.matches, ...medoids];
    if (this.points.length <= 24) wanted.push(...d3.range(this.points.length));
    const taken = [];
    this.labels.selectAll("*").remove();
    for (const material of new Set(wanted)) {
      const [x, y] = at(material);
      if (x < 0 || x > this.width || y < 0 || y > this.height) continue;
      const label = this.labels.append("text").attr("class", "halo").text(study.materials[material].name);
      const width = label.node().getComputedTextLength();
      const right = x + 10 + width < this.width;
      label.attr("x", right ? x + 9 : x - 9).attr("y", y + 4).attr("text-anchor", right ? "start" : "end");
      const left = right ? x + 9 : x - 9 - width;
      const box = {left, right: left + width, top: y - 7, bottom: y + 7};
      const covers = (other) =>
        box.left < other.right && other.left < box.right && box.top < other.bottom && other.top < box.bottom;
      if (taken.some(covers)) label.remove();
      else taken.push(box);
    }
  }
}

"use strict";
// The study: what stands in the page as JSON.

/** Distances by one lighting or comparison metric. */
class Measure {
  constructor(json) {
    Object.assign(this, json);
    for (const key of ["distance", "distance_error", "norm", "norm_error"]) this[key] = numbers(json[key]);
    this.unitText = unitText(json.unit);
    this.positive = this.distance.filter((value) => value > 0).sort((a, b) => a - b);
    this.smallest = this.positive.length > 0 ? this.positive[0] : 1;
    this.largest = this.positive.length > 0 ? this.positive[this.positive.length - 1] : 1;
  }

  /** Place in the lower triangle. */
  place(i, j) {
    return i > j ? (i * (i - 1)) / 2 + j : (j * (j - 1)) / 2 + i;
  }

  value(i, j) {
    return i === j ? 0 : this.distance[this.place(i, j)];
  }

  error(i, j) {
    return i === j ? 0 : this.distance_error[this.place(i, j)];
  }

  text(i, j) {
    return i === j ? "0" : estimateText(this.value(i, j), this.error(i, j)) + this.unitText;
  }

  normText(i) {
    return estimateText(this.norm[i], this.norm_error[i]) + this.unitText;
  }

  /** Whether colours show more in a logarithmic scale: the middle of the distances spans more than a decade. */
  spansDecades() {
    const at = (share) => this.positive[Math.floor(share * (this.positive.length - 1))];
    return this.positive.length > 2 && at(0.9) > 10 * at(0.1);
  }

  /** From distances to [0, 1]. */
  shares(scale) {
    if (scale === "log") return d3.scaleLog([this.smallest, this.largest], [0, 1]).clamp(true);
    return d3.scaleLinear([0, this.largest], [0, 1]).clamp(true);
  }

  /**
   * The nearest materials by rising distance, of those that a condition admits. The rank is uncertain where another one
   * of them is as near within the errors of both.
   */
  nearest(material, count, admits) {
    const all = [];
    for (let other = 0; other < study.materials.length; ++other) {
      if (other === material || !admits(other)) continue;
      all.push({material: other, value: this.value(material, other), error: this.error(material, other)});
    }
    all.sort((a, b) => a.value - b.value || a.material - b.material);
    const isAsNear = (a, b) => a !== b && !(Math.abs(a.value - b.value) > a.error + b.error);
    return all.slice(0, count).map((entry) => ({...entry, isUncertain: all.some((other) => isAsNear(entry, other))}));
  }
}

const study = JSON.parse(document.getElementById("data").textContent);
study.measures = study.measures.map((json) => new Measure(json));

/** How each channel counts in means of channels. */
study.shares = study.channel_weights.map((weight) => weight / d3.sum(study.channel_weights));

/** A material's family by name. */
function familyOf(material) {
  return study.families[study.materials[material].family];
}

/** What materials have of channels: those with one have the same for all. */
function channelsOf(material) {
  return study.curves.materials[material].channels;
}

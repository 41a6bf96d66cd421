"use strict";
// Albedos and polar slices of a pair of materials, in the same scales side by side.

/** The albedos of a material by channel, over the angle of incidence. \param top of the scale */
function drawAlbedos(svg, material, top) {
  const width = svg.node().parentElement.clientWidth;
  const height = 190;
  const margin = {left: 34, right: 14, top: 8, bottom: 32};
  svg.attr("width", width).attr("height", height).attr("class", "albedos")
    .attr("role", "img").attr("aria-label", `Albedo of ${study.materials[material].name}`);
  const x = d3.scaleLinear([0, 90], [margin.left, width - margin.right]);
  const y = d3.scaleLinear([0, top], [height - margin.bottom, margin.top]);
  const grid = svg.append("g").attr("transform", `translate(${margin.left},0)`);
  grid.call(d3.axisLeft(y).ticks(5).tickSize(-(width - margin.left - margin.right)));
  grid.selectAll(".tick line").attr("stroke", themeColour("--grid"));
  grid.select(".domain").remove();
  svg.append("g").attr("transform", `translate(0,${height - margin.bottom})`)
    .call(d3.axisBottom(x).tickValues([0, 30, 60, 90]).tickSize(4).tickFormat((angle) => `${angle}°`));
  svg.append("text").attr("x", (width + margin.left) / 2).attr("y", height - 3).attr("text-anchor", "middle")
    .text("albedo by angle of incidence");
  channelsOf(material).forEach((channel, index) => {
    const points = study.curves.theta.map((theta, k) => {
      const error = channel.albedo_error[k];
      return {theta, value: channel.albedo[k], error: error === null ? 0 : error};
    }).filter((point) => point.value !== null);
    const colour = channelColour(index);
    svg.append("path").datum(points).attr("fill", colour).attr("fill-opacity", 0.2)
      .attr("d", d3.area().x((p) => x(p.theta)).y0((p) => y(Math.max(0, p.value - p.error)))
        .y1((p) => y(Math.min(top, p.value + p.error))));
    svg.append("path").datum(points).attr("class", "albedo").attr("fill", "none").attr("stroke", colour)
      .attr("stroke-width", 1.8)
      .attr("d", d3.line().x((p) => x(p.theta)).y((p) => y(p.value)).curve(d3.curveMonotoneX));
    if (points.length === 0) {
      svg.append("text").attr("x", width / 2).attr("y", height / 2).attr("text-anchor", "middle")
        .text("not finite");
    }
  });
}

/** Largest albedo of both, at least 1. */
function albedoTop(materials) {
  const values = materials.flatMap((material) => channelsOf(material).flatMap((channel) => channel.albedo));
  return Math.max(1, 1.05 * d3.max(values));
}

/** Reflectances by angle of incidence and of V, the mean of the channels by their weights. */
function slicesOf(material) {
  const channels = channelsOf(material);
  const shares = channels.length === 1 ? [1] : study.shares;
  return channels[0].reflectance.map((slice, incidence) =>
    slice.map((_, k) => d3.sum(channels, (channel, c) => shares[c] * channel.reflectance[incidence][k])));
}

/** From reflectances to radii: linear, by cube root, or over four decades, as far as the peaks are apart. */
function radialScale(materials) {
  const isSeen = study.curves.theta_out.map((theta) => Math.abs(theta) <= 85);
  const peaks = materials.flatMap(slicesOf).map((slice) => d3.max(slice.filter((_, k) => isSeen[k])))
    .filter((peak) => peak > 0);
  const highest = d3.max(peaks) || 1;
  const ratio = highest / (d3.min(peaks) || highest);
  if (ratio <= 5) return {scale: d3.scaleLinear([0, highest], [0, 1]).clamp(true), text: "linear"};
  if (ratio <= 1000) {
    return {scale: d3.scalePow([0, highest], [0, 1]).exponent(1 / 3).clamp(true), text: "by cube root"};
  }
  return {scale: d3.scaleLog([highest * 1e-4, highest], [0, 1]).clamp(true), text: "logarithmic, four decades"};
}

/** Reflectances in the plane of incidence, light from the left. \param radial as radialScale() gives it */
function drawSlices(svg, material, radial) {
  const width = svg.node().parentElement.clientWidth;
  const radius = Math.min((width - 44) / 2, 190);
  const height = radius + 58;
  svg.attr("width", width).attr("height", height).attr("class", "slices")
    .attr("role", "img")
    .attr("aria-label", `Reflectances of ${study.materials[material].name} in the plane of incidence`);
  const plot = svg.append("g").attr("transform", `translate(${width / 2},${radius + 20})`);
  const at = (degrees, r) => [radius * r * Math.sin((degrees * Math.PI) / 180),
    -radius * r * Math.cos((degrees * Math.PI) / 180)];
  const arc = d3.arc().startAngle(-Math.PI / 2).endAngle(Math.PI / 2);
  for (const share of [1 / 3, 2 / 3, 1]) {
    plot.append("path").attr("fill", "none").attr("stroke", themeColour("--line"))
      .attr("d", arc({innerRadius: radius * share, outerRadius: radius * share}));
    const value = radial.scale.invert(share);
    plot.append("text").attr("class", "halo").attr("x", radius * share).attr("y", 12).attr("text-anchor", "middle")
      .attr("fill", themeColour("--faint")).attr("font-size", 9).text(String(Number(value.toPrecision(2))));
  }
  for (const degrees of d3.range(-90, 91, 30)) {
    const [x, y] = at(degrees, 1);
    plot.append("line").attr("x2", x).attr("y2", y).attr("stroke", themeColour("--grid"));
    if (Math.abs(degrees) === 90) continue;
    const [labelX, labelY] = at(degrees, 1 + 10 / radius);
    plot.append("text").attr("x", labelX).attr("y", labelY + 3).attr("text-anchor", "middle").attr("font-size", 9)
      .text(`${Math.abs(degrees)}°`);
  }
  plot.append("text").attr("x", -radius / 2).attr("y", 12).attr("text-anchor", "middle").attr("font-size", 9)
    .text("retro side");
  const colours = angleColours[theme()];
  slicesOf(material).forEach((slice, incidence) => {
    const points = slice.map((value, k) => at(study.curves.theta_out[k], value > 0 ? radial.scale(value) : 0));
    plot.append("path").attr("class", "slice").attr("d", d3.line()(points)).attr("fill", "none")
      .attr("stroke", colours[incidence % colours.length]).attr("stroke-width", 1.7);
    const [x, y] = at(-study.curves.theta_in[incidence], 1);
    plot.append("circle").attr("cx", x).attr("cy", y).attr("r", 3.5).attr("fill", colours[incidence % colours.length]);
  });
  const key = plot.append("g").attr("transform", `translate(${-radius},30)`);
  study.curves.theta_in.forEach((theta, incidence) => {
    const item = key.append("g").attr("transform", `translate(${(incidence * 2 * radius) / 3},0)`);
    item.append("line").attr("x2", 16).attr("y1", -4).attr("y2", -4).attr("stroke-width", 2)
      .attr("stroke", colours[incidence % colours.length]);
    item.append("text").attr("x", 20).text(`${general(theta, 3)}°`);
  });
}

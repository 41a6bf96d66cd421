"use strict";
// The page: asks for what is shown, and shows the answers.

const $ = (id) => document.getElementById(id);
const distanceLightings = ["point", "daylight", "mean-albedo", "patch:0.5"];
const materialsTold = new Map(); // text -> answer
let planes = [];
let albedos = [];
let compositions = null;
let fitted = null; // the best member so far of a fit that is being made
let editedAt = null;

function say(text, isError = false) {
  $("message").textContent = text;
  $("message").className = isError ? "error" : "";
}

/** What stands for a material beside numbers: names may be long. */
const letterOf = (i) => "ABCDEF"[i];

function nameOf(text) {
  const offer = catalogue.offers.find((one) => one.text === text);
  return offer === undefined ? text : offer.name;
}

function wordOf(text) {
  return materialsTold.get(text)?.word ?? text;
}

/** Texts of all channels; of many the first and the last. */
const listed = (texts) => (texts.length <= 6 ? texts.join(" / ") : `${texts[0]} / … / ${texts.at(-1)} (${texts.length} channels)`);

/** A unit behind a number. */
const behind = (unit) => (unit === "" ? "" : ` ${unit}`);

function shellWord(text) {
  return /^[\w.,:=/+@%-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** Tells how far something is that takes long, in tenths, so that nobody is read numbers all the time. */
function telling(tell, text) {
  let last = 0;
  return (share) => {
    const tenths = Math.floor(10 * share);
    if (tenths > last) tell(`${text} ${10 * tenths} %`);
    last = tenths;
  };
}

/** All answers have come. */
function noteSettled() {
  if (editedAt === null) return;
  const milliseconds = Math.round(performance.now() - editedAt);
  editedAt = null;
  document.body.dataset.milliseconds = milliseconds;
  $("timing").textContent = `All pictures and numbers ${milliseconds} ms after the last change.`;
}

// Materials.

function drawCards() {
  const list = $("cards");
  list.replaceChildren();
  state.materials.forEach((text, i) => {
    const item = document.createElement("li");
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = colours[i];
    const name = button(nameOf(text), () => change((now) => { now.selected = i; }));
    name.className = "name";
    name.setAttribute("aria-pressed", String(i === state.selected));
    const letter = document.createElement("span");
    letter.className = "letter";
    letter.textContent = letterOf(i);
    item.append(swatch, letter, name);
    if (state.materials.length > 1) {
      const remove = button("Remove", () => change((now) => {
        now.materials.splice(i, 1);
        now.selected = Math.min(now.selected, now.materials.length - 1);
      }));
      remove.setAttribute("aria-label", `Remove ${nameOf(text)}`);
      item.append(remove);
    }
    list.append(item);
  });
  $("add").disabled = state.materials.length >= mostMaterials;
}

function addMaterial(text) {
  if (state.materials.length >= mostMaterials) return say(`Six materials are shown at most; remove one first.`);
  change((now) => {
    now.materials.push(text);
    now.selected = now.materials.length - 1;
  });
}

function exampleOf(model) {
  const words = model.parameters.map((one) => `${one.name}=${one.default ?? one.typical}`);
  return model.name + (words.length > 0 ? `:${words.join(",")}` : "");
}

function fillChoices() {
  const add = $("add");
  add.replaceChildren(new Option("a material …", ""));
  const group = (label, options) => {
    const made = document.createElement("optgroup");
    made.label = label;
    made.append(...options);
    if (options.length > 0) add.append(made);
  };
  group("given", catalogue.offers.map((one) => new Option(one.name, one.text)));
  group("metals and dielectrics", catalogue.starts.map((one) => new Option(one.name, one.text)));
  group("models", catalogue.models.map((one) => new Option(one.name, exampleOf(one))));
  const term = $("add-term");
  term.replaceChildren(new Option("a model …", ""), ...catalogue.models.map((one) => new Option(one.name, one.name)));
}

function showMaterial() {
  const text = state.materials[state.selected];
  ask("material", "material", { material: text }, (answer, error) => {
    $("specification-error").textContent = error === null ? "" : error.message;
    if (error !== null) return;
    materialsTold.set(text, answer);
    if (text === state.materials[state.selected]) showEdited(text, answer);
  });
  state.materials.forEach((one, i) => {
    if (one === text || materialsTold.has(one)) return;
    ask(`word ${i}`, "material", { material: one }, (answer) => {
      if (answer !== null) materialsTold.set(one, answer);
    });
  });
}

// Curves.

const listOf = (answer, xName) => ({ x: answer[xName], y: answer.values.map(number), error: answer.errors.map(number) });

function drawPlane() {
  const weigh = (one) => {
    if (state.quantity === "f") return one;
    const cosines = one.x.map((angle) => Math.cos(radians(angle)));
    const dots = (one.dots ?? []).map((dot) => {
      const cosine = Math.cos(radians(dot.x));
      return { x: dot.x, y: dot.y * cosine, deviation: dot.deviation * cosine };
    });
    return { ...one, dots, y: one.y.map((value, i) => value * cosines[i]), error: one.error.map((value, i) => value * cosines[i]) };
  };
  const series = planes.map((one, i) => (one ? weigh({ ...one, dots: samples[i] }) : one)).filter((one) => one);
  if (compositions !== null) series.push(...compositions.map(weigh));
  if (fitted !== null) series.push(weigh(fitted));
  if (series.length === 0) return;
  const yLabel = state.quantity === "f" ? "f, 1/sr" : "f cos θ out, 1/sr";
  const options = { label: `Values in the plane of incidence for light from ${state.theta}°`, scale: state.scale };
  if (state.form === "polar") {
    drawPolar($("plane-picture"), series, { ...options, light: state.theta });
  } else {
    drawChart($("plane-picture"), series, {
      ...options, from: -90, to: 90, yLabel, onPoint: showValue,
      xLabel: "angle of view; below 0 on the side of the light",
    });
  }
}

/** Answers may come when their material has been taken away. */
const isShown = (i) => i < state.materials.length;

/** Samples of files near the plane of incidence. */
const samples = [];

function showSamples() {
  samples.length = state.materials.length;
  state.materials.forEach((text, i) => {
    if (text !== samples[i]?.text) samples[i] = undefined;
    ask(`samples ${i}`, "samples", { material: text, theta_in: state.theta, phi_in: state.phi }, (answer, error, isPart) => {
      if (!isShown(i)) return drawNext(drawPlane);
      const list = error !== null ? [] : answer.samples;
      samples[i] = list.map((one) => ({ x: one.theta_out, y: number(one.value), deviation: number(one.deviation ?? 0) }));
      samples[i].text = text;
      samples[i].near = answer?.near_deg;
      const all = samples.reduce((sum, own) => sum + (own?.length ?? 0), 0);
      const near = samples.find((own) => own?.length > 0)?.near;
      $("samples-note").textContent = all === 0 ? "" : `Dots: ${counted(all, "sample")} within ${general(near, 2)}° ` +
        "of the angle of light and of the plane, with their stated deviations; by reciprocity also those of exchanged directions.";
      if (!isPart) drawNext(drawPlane);
    });
  });
}

function showPlanes() {
  planes.length = state.materials.length;
  state.materials.forEach((text, i) => {
    ask(`plane ${i}`, "plane", { material: text, theta_in: state.theta, phi_in: state.phi }, (answer, error, isPart) => {
      if (isShown(i)) planes[i] = error !== null ? null : { name: nameOf(text), colour: colours[i], ...listOf(answer, "theta_out") };
      if (error !== null) say(`${nameOf(text)}: ${error.message}`, true);
      if (!isPart) drawNext(drawPlane);
    });
  });
}

/** Dark blue to yellow, as bright as the value: people with any colour vision see the same order. */
function heat(share) {
  const stops = [[13, 8, 60], [70, 50, 130], [150, 70, 110], [225, 120, 60], [250, 230, 90]];
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const low = Math.min(Math.floor(place), stops.length - 2);
  return stops[low].map((part, i) => Math.round(part + (stops[low + 1][i] - part) * (place - low)));
}

const slices = [];

function drawSlices() {
  const row = $("slice-row");
  row.replaceChildren();
  const all = slices.flatMap((one) => one?.values ?? []).map(number).filter(Number.isFinite);
  const { place, marks } = heights(all, state.scale === "linear" ? "log" : state.scale);
  slices.forEach((one, i) => {
    if (one === null || one === undefined) return;
    const canvas = document.createElement("canvas");
    canvas.width = one.nodes;
    canvas.height = one.nodes;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `half-difference slice of ${letterOf(i)}`);
    const image = new ImageData(one.nodes, one.nodes);
    one.values.forEach((value, at) => {
      const pixel = (one.nodes - 1 - Math.floor(at / one.nodes)) * one.nodes + (at % one.nodes);
      image.data.set([...heat(place(number(value))), 255], 4 * pixel);
    });
    canvas.getContext("2d").putImageData(image, 0, 0);
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    caption.textContent = letterOf(i);
    figure.append(canvas, caption);
    row.append(figure);
  });
  const ends = marks.length > 1 ? ` From ${general(marks[0], 2)} (dark) to ${general(marks.at(-1), 2)} 1/sr (bright), ` +
    `${state.scale === "cbrt" ? "by cube roots" : "logarithmic"}.` : "";
  $("slice-note").textContent = `Right: θ_h from 0 to 90° by its square root; up: θ_d from 0 to 90°; φ_d = 90°.${ends}`;
}

function showSlices() {
  slices.length = state.materials.length;
  state.materials.forEach((text, i) => {
    ask(`slice ${i}`, "slice", { material: text }, (answer, error, isPart) => {
      if (isShown(i)) slices[i] = error !== null ? null : answer;
      if (!isPart) drawNext(drawSlices);
    });
  });
}

function showCompositions() {
  if (!state.compose || state.materials.length < 2) {
    forget("composition");
    compositions = null;
    $("plane-note").textContent = state.compose ? "A composition takes two materials." : "";
    return;
  }
  const [a, b] = state.materials;
  ask("composition", "composition", { a, b, theta_in: state.theta, phi_in: state.phi }, (answer, error) => {
    compositions = [];
    const reasons = error === null ? [] : [error.message];
    for (const [key, first, second, dash] of [["ab", a, b, "7 3"], ["ba", b, a, "2 3"]]) {
      const part = answer?.[key];
      if (part === undefined) continue;
      const name = `composition of ${nameOf(first)} and ${nameOf(second)}`;
      if (part.reason !== undefined) reasons.push(`${name}: ${part.reason}`);
      else compositions.push({ name, colour: "#808080", dash, ...listOf({ ...part, theta_out: answer.theta_out }, "theta_out") });
    }
    $("plane-note").textContent = reasons.length > 0
      ? reasons.join(" ") : "Long dashes: the first material, then the second; dots: the second, then the first.";
    drawNext(drawPlane);
  }, true);
}

function drawAlbedos() {
  const series = albedos.filter((one) => one !== null && one !== undefined);
  if (series.length === 0) return;
  drawChart($("albedo-picture"), series, {
    label: "Albedo against the angle of incidence", from: 0, to: 90, scale: "linear", line: 1, yLabel: "albedo",
    xLabel: "angle of incidence",
  });
  const worst = Math.max(...series.flatMap((one) => one.error.filter((error) => Number.isFinite(error))));
  $("albedo-note").textContent = `Luminance of all channels; the largest error is ${general(worst, 2)}.`;
}

function showAlbedos() {
  albedos.length = state.materials.length;
  state.materials.forEach((text, i) => {
    ask(`albedo ${i}`, "albedos", { material: text, phi_in: state.phi }, (answer, error, isPart) => {
      if (isShown(i)) albedos[i] = error !== null ? null : { name: nameOf(text), colour: colours[i], ...listOf(answer, "theta_in") };
      if (error !== null) $("albedo-note").textContent = `${nameOf(text)}: ${error.message}`;
      if (!isPart) drawNext(drawAlbedos);
    });
  });
}

const spectra = [];

/** Values of many channels at the pair of directions that was pointed at, over their wavelengths where they have some. */
function drawSpectra() {
  spectra.length = state.materials.length;
  const series = [];
  spectra.forEach((channels, i) => {
    if (channels === null || channels === undefined) return;
    const names = materialsTold.get(state.materials[i])?.channel_names ?? [];
    const places = channels.map((one, c) => (names[c] === undefined ? NaN : Number.parseFloat(names[c])));
    const x = places.every(Number.isFinite) ? places : channels.map((one, c) => c + 1);
    series.push({ name: nameOf(state.materials[i]), colour: colours[i], x, y: channels.map((one) => number(one.value)),
      error: channels.map((one) => number(one.error)) });
  });
  const box = $("spectrum-picture");
  if (series.length === 0) {
    box.replaceChildren();
    return;
  }
  const all = series.flatMap((one) => one.x);
  drawChart(box, series, { label: "Values of the channels at this pair of directions", from: Math.min(...all), to: Math.max(...all),
    scale: "linear", xLabel: "wavelength, nm, or number of the channel", yLabel: "f, 1/sr", unit: "" });
}

/** What was pointed at is of other materials, or of another light. */
function forgetValue() {
  state.materials.forEach((text, i) => forget(`value ${i}`));
  spectra.length = 0;
  drawNext(drawSpectra);
  $("value").textContent = "Point at the picture for values with their errors.";
}

/** Values of all materials at an angle of view, with their errors. */
function showValue(angle) {
  const lines = state.materials.map(() => "");
  state.materials.forEach((text, i) => {
    const pair = { theta_in: state.theta, theta_out: Math.min(Math.abs(angle), 89.99), delta_phi: angle < 0 ? 0 : 180, phi_in: state.phi };
    ask(`value ${i}`, "value", { material: text, ...pair }, (answer, error) => {
      const texts = error !== null ? [error.message] : answer.channels.map((one) =>
        (number(one.error) === 0 ? general(number(one.value), 8) : told(one)));
      lines[i] = `${letterOf(i)}: ${listed(texts)} 1/sr`;
      spectra[i] = error === null && answer.channels.length > 6 ? answer.channels : null;
      drawNext(drawSpectra);
      $("value").textContent = `From ${general(state.theta, 4)}° to ${general(Math.abs(angle), 4)}° ` +
        `${angle < 0 ? "on the side of the light" : "on the mirror side"}. ${lines.filter((line) => line !== "").join("; ")}`;
    });
  });
}

// Numbers.

function tableOf(table, head, rows) {
  const line = (cells, name) => {
    const row = document.createElement("tr");
    cells.forEach((cell, i) => {
      const made = document.createElement(i === 0 || name === "th" ? "th" : "td");
      if (name === "th") made.scope = "col";
      else if (i === 0) made.scope = "row";
      made.textContent = cell.text ?? cell;
      if (cell.isBad) made.classList.add("bad");
      if (name !== "th" && i > 0 && /^[-\d.]/.test(made.textContent)) made.classList.add("number");
      row.append(made);
    });
    return row;
  };
  const tableHead = document.createElement("thead");
  tableHead.append(line(head, "th"));
  const body = document.createElement("tbody");
  body.append(...rows.map((row) => line(row, "td")));
  table.replaceChildren(tableHead, body);
}

let checks = [];

function verdict(answer) {
  const faults = [];
  const all = (key) => answer.channels.every((one) => one[key]);
  if (!all("is_non_negative")) faults.push("negative values");
  if (!all("is_reciprocal")) faults.push("not reciprocal");
  if (!all("conserves_energy")) faults.push("more light than it gets");
  return faults.length === 0 ? "plausible" : `implausible: ${faults.join(", ")}`;
}

function drawChecks() {
  const box = $("checks");
  box.replaceChildren();
  state.materials.forEach((text, i) => {
    const head = document.createElement("h3");
    head.className = "short";
    head.textContent = `${letterOf(i)}  ${nameOf(text)}`;
    head.title = nameOf(text);
    const list = document.createElement("dl");
    const add = (name, value, isBad = false) => {
      const term = document.createElement("dt");
      term.textContent = name;
      const told = document.createElement("dd");
      told.textContent = value;
      if (isBad) told.className = "bad";
      list.append(term, told);
    };
    const found = checks[i];
    if (found === undefined || found === null) {
      add("verdict", "…");
    } else if (found.reason !== undefined) {
      add("verdict", found.reason);
    } else {
      const byChannel = (tell) => listed(found.channels.map(tell));
      add("verdict", verdict(found), !found.is_plausible);
      if (found.channels[0].mean_albedo !== undefined) add("mean albedo", byChannel((one) => told(one.mean_albedo)));
      add("largest albedo", byChannel((one) => (one.growth !== undefined
        ? `without bound: it grows towards grazing incidence with the exponent ${told(one.growth)}`
        : `${told(one.largest_albedo)} at ${general(one.largest_albedo_at.theta_deg, 8)}°`)));
      add("reciprocity defect", byChannel((one) => general(number(one.reciprocity_defect), 2)));
    }
    box.append(head, list);
  });
}

function showChecks() {
  checks = state.materials.map((text, i) => (checks[i]?.text === text ? checks[i] : null));
  state.materials.forEach((text, i) => {
    if (checks[i] !== null) return;
    ask(`check ${i}`, "check", { material: text }, (answer, error) => {
      if (text !== state.materials[i]) return;
      checks[i] = error !== null ? { reason: error.message, text } : { ...answer, text };
      drawNext(drawChecks);
    });
  });
  drawNext(drawChecks);
}

let distances = {};

function drawDistances() {
  const pairs = [];
  state.materials.forEach((first, i) => state.materials.forEach((second, j) => {
    if (i < j) pairs.push([i, j]);
  }));
  const rows = pairs.map(([i, j]) => [
    `${letterOf(i)} – ${letterOf(j)}`,
    ...distanceLightings.map((lighting) => {
      const found = distances[lighting]?.pairs?.find((one) => one.first === i && one.second === j);
      if (distances[lighting]?.reason !== undefined) return distances[lighting].reason;
      if (found === undefined) return "…";
      if (found.reason !== undefined) return found.reason;
      return `${told(found.distance)}${behind(distances[lighting].unit)}; angle ${told(found.angle_deg)}°`;
    }),
  ]);
  tableOf($("distance-table"), ["pair", ...distanceLightings], rows);
}

function showDistances() {
  distances = {};
  if (state.materials.length < 2) {
    $("distance-table").replaceChildren();
    return;
  }
  const materials = [...state.materials];
  const { domain } = state;
  for (const lighting of distanceLightings) {
    if (isInGesture && lighting.startsWith("patch")) continue; // asked when the slider rests
    ask(`distance ${lighting}`, "distances", { materials, lighting, theta_max: state.domain }, (answer, error) => {
      if (JSON.stringify(materials) !== JSON.stringify(state.materials) || domain !== state.domain) return;
      distances[lighting] = error !== null ? { reason: error.message } : answer;
      drawNext(drawDistances);
    }, lighting.startsWith("patch"));
  }
  drawNext(drawDistances);
}

function findNearest() {
  const lighting = $("nearest-lighting").value;
  const text = state.materials[state.selected];
  const doing = `Compares ${nameOf(text)} with ${counted(catalogue.offers.length, "material")} …`;
  const tell = (line) => { $("nearest-note").textContent = line; };
  tell(doing);
  ask("nearest", "nearest", { material: text, lighting }, (answer, error) => {
    $("nearest-list").replaceChildren();
    if (error !== null) {
      $("nearest-note").textContent = error.message;
      return;
    }
    for (const one of answer.nearest) {
      const item = document.createElement("li");
      item.append(`${one.name}, ${told(one.distance)}${behind(answer.unit)} `, button("Show", () => addMaterial(one.text)));
      $("nearest-list").append(item);
    }
    const refused = answer.refused > 0 ? `; ${counted(answer.refused, "other")} cannot be compared with it` : "";
    $("nearest-note").textContent = `Nearest to ${nameOf(text)} of ${counted(answer.compared, "material")} under ${lighting}${refused}.`;
  }, true, false, telling(tell, doing));
}

function startFit(event) {
  event.preventDefault();
  const target = $("fit-target").value;
  const doing = `Fits ${$("family").value} to ${nameOf(target)} …`;
  const tell = (line) => { $("fit-note").textContent = line; };
  forgetFitted(); // of a fit that this one replaces
  tell(doing);
  let best = null;
  const rounded = (text) => text.replace(/\d+\.\d+(e[+-]?\d+)?/g, (digits) => general(Number(digits), 3));
  const tellShare = telling((line) => tell(best === null ? line : `${line}; so far ${rounded(best.material)}`), doing);
  const watch = (share, found) => {
    if (found !== undefined && found.material !== best?.material) {
      best = found;
      fitted = { name: `best so far: ${best.material}`, colour: "#808080", dash: "4 4", ...listOf(best.plane, "theta_out") };
      drawNext(drawPlane);
    }
    tellShare(share);
  };
  ask("fit", "fit", { material: target, family: $("family").value, theta_in: state.theta, phi_in: state.phi }, (answer, error) => {
    forgetFitted();
    if (error !== null) {
      $("fit-note").textContent = error.message;
      return;
    }
    const end = answer.has_converged ? "" : " The search ended before it converged.";
    $("fit-note").textContent = `${answer.material}: off by ${told(answer.relative_residual)} of the norm of ${nameOf(target)}, under point light.${end}`;
    if (answer.material !== "") addMaterial(answer.material);
  }, true, false, watch);
}

function forgetFitted() {
  if (fitted === null) return;
  fitted = null;
  drawNext(drawPlane);
}

// What is shown, as a whole.

function commandText() {
  const words = state.materials.map((text) => shellWord(wordOf(text)));
  const scenes = catalogue.scenes.filter((one) => one.text === "").map((one) => ` --scene ${shellWord(one.word)}`);
  const lines = [`lobe view ${words.join(" ")}${scenes.join("")}`, `lobe check ${words.join(" ")}`];
  for (const word of words) lines.push(`lobe albedo ${word} --theta 0,30,60,85`);
  if (words.length > 1) {
    for (const lighting of distanceLightings) {
      const domain = state.domain < 90 ? ` --domain-theta-max ${state.domain}` : "";
      lines.push(`lobe distance ${words[0]} ${words[1]} --lighting ${lighting}${domain}`);
    }
  }
  if (state.scene.draw) lines.push(sceneCommand());
  return `${lines.join("\n")}\n`;
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    say(`${what} copied.`);
  } catch {
    say(`The browser does not let the page copy. ${text}`);
  }
}

/** Shows the state; what has not changed since is not asked again. */
let shownParts = {};
function showState() {
  window.history.replaceState(null, "", stateLink());
  if (editedAt === null) editedAt = performance.now();
  document.body.dataset.milliseconds = "";
  const parts = {
    cards: [state.materials, state.selected],
    material: [state.materials, state.selected],
    spheres: [state.materials, state.light],
    planes: [state.materials, state.theta, state.phi],
    samples: [state.materials, state.theta, state.phi],
    compositions: [state.materials.slice(0, 2), state.theta, state.phi, state.compose],
    albedos: [state.materials, state.phi],
    checks: [state.materials],
    distances: [state.materials, state.domain],
    slices: [state.materials],
    lobes: [state.materials, state.theta, state.phi],
    pointed: [state.materials, state.theta, state.phi],
    scene: [state.materials[state.selected], state.scene],
    drawn: [state.quantity, state.scale, state.form],
    eye: [state.eye],
  };
  const show = { cards: drawCards, material: showMaterial, spheres: showSpheres, planes: showPlanes, samples: showSamples, compositions: showCompositions,
    albedos: showAlbedos, checks: showChecks, distances: showDistances, slices: showSlices,
    lobes: showLobes,
    pointed: forgetValue,
    scene: showScene,
    eye: () => drawNext(drawLobes),
    drawn: () => {
      drawNext(drawPlane);
      drawNext(drawLobes);
      drawNext(drawSlices);
    } };
  const news = Object.keys(parts).filter((key) => JSON.stringify(parts[key]) !== shownParts[key]);
  for (const key of news) {
    shownParts[key] = JSON.stringify(parts[key]);
    show[key]();
  }
  if (news.includes("compositions")) drawNext(drawPlane);
  const set = (id, value) => {
    if (document.activeElement !== $(id) || $(id).type === "range") $(id).value = value;
  };
  set("theta", state.theta);
  set("theta-number", state.theta);
  set("phi", state.phi);
  set("quantity", state.quantity);
  set("scale", state.scale);
  set("form", state.form);
  set("domain", String(state.domain));
  set("eye-turn", state.eye.turn);
  set("eye-lift", state.eye.lift);
  set("light-mode", state.light.mode);
  set("light-azimuth", state.light.azimuth);
  set("light-tilt", state.light.tilt);
  set("light-colour", state.light.colour);
  set("sky-colour", state.light.sky);
  $("fill-lights").checked = state.light.fill;
  $("compose").checked = state.compose;
  $("undo").disabled = past.length === 0;
  $("redo").disabled = future.length === 0;
  const target = $("fit-target");
  const chosen = target.value;
  target.replaceChildren(...state.materials.map((text, i) => new Option(letterOf(i), text, false, text === chosen)));
  if (open === 0) noteSettled();
}

async function takeFile(file) {
  say(`Reads ${file.name} …`);
  try {
    const response = await fetch(`file?name=${encodeURIComponent(file.name)}`, {
      method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file,
    });
    const answer = response.status === 413 ? { error: `${file.name} is larger than 256 MiB` } : await response.json();
    if (answer.error !== undefined) throw new Error(answer.error);
    catalogue.offers.push(answer);
    fillChoices();
    say(`${answer.name} is shown.`);
    addMaterial(answer.text);
  } catch (error) {
    say(error.message, true);
  }
}

function onSlide(id, apply) {
  $(id).addEventListener("input", () => change((now) => apply(now, $(id).value), true));
  $(id).addEventListener("change", endGesture);
}

function onChoice(id, apply) {
  $(id).addEventListener("change", () => change((now) => apply(now, $(id).type === "checkbox" ? $(id).checked : $(id).value)));
}

function listen() {
  $("undo").addEventListener("click", () => travel(past, future));
  $("redo").addEventListener("click", () => travel(future, past));
  $("copy-command").addEventListener("click", () => copy(commandText(), "Commands"));
  $("copy-link").addEventListener("click", () => copy(window.location.href, "Link"));
  $("file").addEventListener("change", () => {
    if ($("file").files.length > 0) takeFile($("file").files[0]);
    $("file").value = "";
  });
  $("add").addEventListener("change", () => {
    if ($("add").value !== "") addMaterial($("add").value);
    $("add").value = "";
  });
  $("add-term").addEventListener("change", () => {
    const model = modelOf($("add-term").value);
    $("add-term").value = "";
    if (model === undefined || edited === null) return;
    edited.terms.push({ model: model.name, parameters: typicalValues(model.parameters), weight: [1] });
    applyEdit(false, true);
  });
  $("specification-form").addEventListener("submit", (event) => {
    event.preventDefault();
    const text = $("specification").value.trim();
    ask("typed", "material", { material: text }, (answer, error) => {
      $("specification-error").textContent = error === null ? "" : error.message;
      if (error === null) change((now) => { now.materials[now.selected] = text; });
    });
  });
  $("save-toml").addEventListener("click", () => {
    const told = materialsTold.get(state.materials[state.selected]);
    if (told?.toml !== undefined) save("material.toml", told.toml, "text/plain");
  });
  $("save-table").addEventListener("click", () => {
    const text = state.materials[state.selected];
    const doing = `Tabulates ${nameOf(text)} …`;
    say(doing);
    ask("table", "table", { material: text }, (answer, error) => {
      if (error !== null) return say(error.message, true);
      const bytes = Uint8Array.from(atob(answer.bytes), (letter) => letter.charCodeAt(0));
      save("table.h5", new Blob([bytes], { type: "application/x-hdf5" }));
      return say(`${nameOf(text)} is saved on the grid ${answer.grid}, ${general(bytes.length / 1024, 3)} KiB.`);
    }, true, false, telling(say, doing));
  });
  onChoice("light-mode", (now, value) => { now.light.mode = value; });
  onChoice("fill-lights", (now, value) => { now.light.fill = value; });
  onSlide("light-azimuth", (now, value) => { now.light.azimuth = Number(value); });
  onSlide("light-tilt", (now, value) => { now.light.tilt = Number(value); });
  onSlide("light-colour", (now, value) => { now.light.colour = value; });
  onSlide("sky-colour", (now, value) => { now.light.sky = value; });
  onSlide("eye-turn", (now, value) => { now.eye.turn = Number(value); });
  onSlide("eye-lift", (now, value) => { now.eye.lift = Number(value); });
  onSlide("theta", (now, value) => { now.theta = Number(value); });
  const angle = (value, low, high) => Math.min(Math.max(Number(value) || 0, low), high);
  onChoice("theta-number", (now, value) => { now.theta = angle(value, 0, 89); });
  onChoice("phi", (now, value) => { now.phi = angle(value, -360, 360); });
  onChoice("quantity", (now, value) => { now.quantity = value; });
  onChoice("scale", (now, value) => { now.scale = value; });
  onChoice("form", (now, value) => { now.form = value; });
  onChoice("domain", (now, value) => { now.domain = Number(value); });
  onChoice("compose", (now, value) => { now.compose = value; });
  $("save-spheres").addEventListener("click", saveSpheres);
  $("plane-csv").addEventListener("click", () => save("plane.csv", csvOf([...planes, ...(compositions ?? [])].filter(Boolean), "theta_out_deg", "f"), "text/csv"));
  $("plane-svg").addEventListener("click", () => saveSvg($("plane-picture"), "plane.svg"));
  $("albedo-csv").addEventListener("click", () => save("albedo.csv", csvOf(albedos.filter(Boolean), "theta_in_deg", "albedo"), "text/csv"));
  $("albedo-svg").addEventListener("click", () => saveSvg($("albedo-picture"), "albedo.svg"));
  $("find-nearest").addEventListener("click", findNearest);
  $("fit-form").addEventListener("submit", startFit);
  $("fit-cancel").addEventListener("click", () => {
    forget("fit");
    forgetFitted();
    $("fit-note").textContent = "";
  });
  document.addEventListener("keydown", (event) => {
    const isText = /^(text|number)$/.test(event.target.type ?? "");
    if (!(event.ctrlKey || event.metaKey) || isText || event.key.toLowerCase() !== "z") return;
    event.preventDefault();
    if (event.shiftKey) travel(future, past);
    else travel(past, future);
  });
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  document.addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    if (event.dataTransfer.files.length > 0) takeFile(event.dataTransfer.files[0]);
  });
  window.addEventListener("resize", () => {
    drawNext(drawPlane);
    drawNext(drawSpectra);
    drawNext(drawAlbedos);
  });
}

async function begin() {
  try {
    catalogue = await send("catalogue", {}, "");
  } catch (error) {
    say(error.message, true);
    return;
  }
  state.scene = sceneOf(null);
  if (!readLink(window.location.hash)) {
    state.materials = catalogue.offers.slice(0, catalogue.first_shown).map((one) => one.text);
  }
  fillChoices();
  fillScenes();
  listen();
  listenToScene();
  showState();
}

begin();

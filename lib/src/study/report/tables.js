"use strict";
// Tables, the pair, commands and provenance. All texts of the study become text nodes.

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/** A table in a box of its own, which scrolls sideways where the page is narrower. */
function table(heads, rows, isNumber) {
  const cell = (tag) => (content, column) => {
    if (content instanceof HTMLElement && content.tagName === "TD") return content;
    return element(tag, isNumber(column) ? {class: "number"} : {}, content);
  };
  return element("div", {class: "scroll"}, element("table", {},
    element("thead", {}, element("tr", {}, ...heads.map(cell("th")))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row.map(cell("td")))))));
}

/** Lines of comma-separated values, quoted as RFC 4180 has it; what is not known is left empty. */
function csvText(rows) {
  const field = (value) => {
    if (typeof value === "number") return Number.isNaN(value) ? "" : String(value);
    return /[",\r\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value;
  };
  return rows.map((row) => `${row.map(field).join(",")}\r\n`).join("");
}

/** Lets the reader keep a text as a file. */
function saveFile(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], {type}));
  const link = element("a", {href: address, download: name});
  link.click();
  URL.revokeObjectURL(address);
}

/** A button that saves comma-separated values; rows() gives them with their heads. */
function csvButton(what, rows) {
  const name = `${study.study_file.replace(/\.toml$/, "")}.${what}.csv`;
  return element("button", {type: "button", class: "csv", onclick: () => saveFile(name, "text/csv", csvText(rows()))},
    "Save as CSV");
}

/** Every pair under one measure, with errors. */
function distanceRows(measure) {
  const unit = measure.unit === "1" ? "" : ` / ${measure.unit}`;
  const rows = [["first", "second", `distance${unit}`, `error${unit}`]];
  for (let i = 1; i < study.materials.length; ++i) {
    for (let j = 0; j < i; ++j) {
      rows.push([study.materials[j].name, study.materials[i].name, measure.value(i, j), measure.error(i, j)]);
    }
  }
  return rows;
}

/** Residuals of every material for every family, with errors. */
function residualRows(families, rows) {
  return [["material", "family of the material", ...families.flatMap((name) => [name, `${name} error`])],
    ...rows.map((row, material) => {
      const [values, errors] = [numbers(row.residual), numbers(row.residual_error)];
      return [study.materials[material].name, familyOf(material), ...values.flatMap((value, k) => [value, errors[k]])];
    })];
}

async function copy(text, button) {
  const label = button.dataset.label ?? button.textContent;
  button.dataset.label = label;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Pages from files may have no clipboard of their own.
    const area = element("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = label; }, 1500);
}

/** A command with a button that copies it. Lines break between words, not at hyphens. */
function commandLine(text) {
  const words = text.split(" ").flatMap((word) => [" ", element("span", {class: "word"}, word)]).slice(1);
  return element("div", {class: "command"}, element("code", {}, ...words),
    element("button", {type: "button", onclick: (event) => copy(text, event.target)}, "Copy"));
}

/** The lit sphere of a material, as a list of no or one picture. The name beside it says what it shows. */
function sphere(material, size) {
  const source = study.spheres[material];
  return source ? [element("img", {class: "sphere", src: source, width: size, height: size, alt: ""})] : [];
}

/** A name that chooses the material. */
function materialLink(material, actions) {
  return element("button", {type: "button", class: "link", onclick: () => actions.chooseNext(material)},
    ...sphere(material, 24), study.materials[material].name);
}

/** The command that measures a pair again; where none does, the one that made the study. */
function pairCommand(measure, first, second) {
  const [a, b] = [study.materials[first], study.materials[second]];
  if (measure.arguments === null) return null;
  if (a.operand !== null && b.operand !== null) return `lobe distance ${a.operand} ${b.operand} ${measure.arguments}`;
  const families = [...new Set([a.family, b.family])].map((family) => `--family ${study.family_words[family]}`);
  return `lobe distance-matrix ${study.study_file_word} ${families.join(" ")} ${measure.arguments} --csv`;
}

function commandsFor(command, what) {
  if (command !== null) return [commandLine(command)];
  return [element("p", {class: "note"}, `No command computes ${what} by itself; this one computed the study:`),
    commandLine(study.provenance.command_line)];
}

function drawPair(state, actions) {
  const box = document.getElementById("pair-content");
  const {first, second} = state;
  const measure = study.measures[state.measure];
  if (first === second) {
    box.replaceChildren(element("p", {class: "note"}, "There is but one material."));
    return;
  }
  const relative = measure.value(first, second) / Math.max(measure.norm[first], measure.norm[second]);
  const size = measure.is_lighting ? "norm" : "distance from black";
  const rows = [
    ["distance", measure.text(first, second)],
    [`${size} of the first`, measure.normText(first)],
    [`${size} of the second`, measure.normText(second)],
    ["distance / the larger one", Number.isFinite(relative) ? general(relative, 4) : "not known"],
  ];
  const sides = element("div", {class: "sides"}, ...[first, second].map((material) => side(material)));
  box.replaceChildren(table(["", measure.name], rows, () => false),
    element("div", {class: "buttons"}, element("button", {type: "button", id: "pair-link",
      onclick: (event) => copy(pairAddress(state), event.target)}, "Copy link to this pair")),
    sides,
    element("h3", {}, "To compute the distance again"),
    ...commandsFor(pairCommand(measure, first, second), "this distance"));
  if (study.curves === null) {
    const note = "This study was computed by an older version, which kept no albedos and slices; run it again.";
    sides.after(element("p", {class: "note", id: "no-curves"}, note));
  } else {
    drawSides(sides, [first, second]);
  }
  const curveOperands = [first, second].map((material) => study.materials[material].curve_operand);
  if (study.curves === null || curveOperands.includes(null)) return;
  box.append(element("h3", {}, "To compute the albedos again"),
    ...curveOperands.map((operand) => commandLine(`lobe albedo ${operand} ${study.albedo_arguments}`)));
}

function side(material) {
  const symbol = d3.create("svg").attr("width", 14).attr("height", 14).attr("viewBox", "-7 -7 14 14")
    .style("display", "inline-block").style("vertical-align", "-2px");
  symbol.append("path").attr("d", familySymbol(study.materials[material].family, 64))
    .attr("fill", familyColour(study.materials[material].family));
  const [name, ...notes] = materialLines(material);
  return element("div", {class: "side"},
    element("div", {class: "head"}, ...sphere(material, 64), element("div", {},
      element("h3", {}, symbol.node(), ` ${name}`),
      ...notes.map((note) => element("p", {class: "note"}, note)))));
}

function drawSides(sides, materials) {
  const top = albedoTop(materials);
  const radial = radialScale(materials);
  [...sides.children].forEach((box, index) => {
    drawAlbedos(d3.select(box).append("svg"), materials[index], top);
    drawSlices(d3.select(box).append("svg"), materials[index], radial);
  });
  const hasDelta = materials.some((material) => study.curves.materials[material].has_delta);
  const note = `f / sr⁻¹ in the plane of incidence, ${radial.text}; dots: where the light comes from` +
    (study.channels.length > 1 ? "; mean of the channels" : "") +
    (hasDelta ? "; ideal mirrors count in albedos alone" : "") + ".";
  sides.after(element("p", {class: "note"}, note));
}

function drawNeighbours(state, actions) {
  const measure = study.measures[state.measure];
  const all = () => true;
  const isFormula = (material) => study.materials[material].file === null;
  const hasBoth = study.materials.some((_, m) => isFormula(m)) && study.materials.some((_, m) => !isFormula(m));
  const parts = [...new Set([state.first, state.second])].map((material) => {
    const part = element("div", {}, element("h3", {}, study.materials[material].name),
      neighbourTable(measure, material, all, actions));
    if (hasBoth && !isFormula(material)) {
      part.append(element("h3", {}, "Formulas alone"), neighbourTable(measure, material, isFormula, actions));
    }
    return part;
  });
  document.getElementById("neighbour-tables").replaceChildren(...parts);
}

function neighbourTable(measure, material, admits, actions) {
  const count = 8;
  const rows = measure.nearest(material, count, admits).map((entry, rank) => [
    `${rank + 1}${entry.isUncertain ? " ~" : ""}`,
    materialLink(entry.material, actions),
    familyOf(entry.material),
    measure.text(material, entry.material),
  ]);
  return table(["", "material", "family", "distance"], rows, (column) => column === 3);
}

function drawApproximations(state, actions) {
  const measure = study.measures[state.measure];
  const box = document.getElementById("approximation-tables");
  if (measure.approximations.length === 0) {
    box.replaceChildren(element("p", {class: "note"}, measure.is_lighting
      ? "The study asks for none; 'approximations' in its [study] does."
      : "Comparison metrics have no scalar product to approximate by."));
    return;
  }
  const parts = [];
  for (const {fit, families, rows} of measure.approximations) {
    const lines = rows.map((row, material) => [materialLink(material, actions), familyOf(material),
      ...residualCells(numbers(row.residual), numbers(row.residual_error))]);
    const title = fit === "linear" ? "Linear combinations" : "Combinations without negative coefficients";
    parts.push(element("h3", {}, title),
      table(["material", "family", ...families], lines, (column) => column > 1),
      csvButton(`${measure.name}.${fit}`, () => residualRows(families, rows)));
  }
  parts.push(element("p", {class: "note"}, "Distance from the nearest combination of the family's other materials, " +
    "relative to the material's norm; the smallest is bold. Errors show on pointing."));
  box.replaceChildren(...parts);
}

function residualCells(values, errors) {
  const best = d3.min(values.filter((value) => Number.isFinite(value)));
  return values.map((value, k) => {
    const text = Number.isFinite(value) ? general(value, 3) : "–";
    const attributes = {class: value === best ? "number best" : "number"};
    if (Number.isFinite(value)) attributes.title = estimateText(value, errors[k]);
    return element("td", attributes, text);
  });
}

function drawAgreement() {
  const section = document.getElementById("agreement");
  section.hidden = study.agreement === null;
  if (section.hidden) return;
  const {metrics, spearman, kendall} = study.agreement;
  const rows = metrics.map((metric, i) =>
    [metric, ...metrics.map((_, j) => (i === j ? "" : general(numbers((j < i ? spearman : kendall)[i])[j], 3)))]);
  document.getElementById("agreement-tables").replaceChildren(
    table(["", ...metrics], rows, (column) => column > 0),
    element("p", {class: "note"}, "All pairs: Spearman's ρ below the diagonal, Kendall's τ-b above."));
}

function drawMatrixCommand(state) {
  const measure = study.measures[state.measure];
  const command = measure.arguments === null ? null
    : `lobe distance-matrix ${study.study_file_word} ${measure.arguments} --csv`;
  document.getElementById("matrix-commands").replaceChildren(...commandsFor(command, "these distances"),
    csvButton(`${measure.name}.distances`, () => distanceRows(measure)));
}

function drawProvenance() {
  const {provenance} = study;
  const entries = [
    ["Computed", provenance.created],
    ["By", provenance.software],
    ["Device", `${provenance.device} (${provenance.device_version})`],
    ["Platform", `${provenance.platform}, driver ${provenance.driver}`],
    ["Precision", provenance.precision],
    ["Tolerance", `${provenance.tolerance}; patch lights ${provenance.patch_tolerance}; comparison metrics ` +
      `${provenance.comparison_tolerance}`],
    ["Grid", provenance.grid === null ? "" : provenance.grid || "none"],
    ["Channels", study.channels.map((name, k) => `${name} × ${general(study.channel_weights[k], 4)}`).join(", ")],
    ["Set from outside", provenance.overrides.join("\n")],
    ["Comment", study.comment],
    ["References", study.references],
    ["HDF5", provenance.hdf5],
    ["Page by", provenance.report],
  ];
  if (study.published_figures > 0) entries.push(["Also in the file", `${study.published_figures} published figures`]);
  if (study.charts > 0) entries.push(["Also in the file", `${study.charts} charts`]);
  const list = document.getElementById("provenance-list");
  for (const [term, text] of entries) {
    if (!text) continue;
    const lines = text.split("\n").map((line) => element("div", {}, line));
    list.append(element("dt", {}, term), element("dd", {}, ...lines));
  }
  document.getElementById("study-commands").append(element("h3", {}, "To compute the study again"),
    commandLine(provenance.command_line),
    element("p", {class: "note"}, `Commands that name ${study.study_file} mean the study file below.`));
  document.getElementById("study-file").textContent = provenance.configuration;
  document.getElementById("save-study").addEventListener("click",
    () => saveFile(study.study_file, "application/toml", provenance.configuration));
}

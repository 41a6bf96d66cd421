"use strict";
// What is chosen, and who draws it.

const state = {
  measure: 0,
  order: "file",
  scale: "linear",
  first: 0,
  second: Math.min(1, study.materials.length - 1),
  matches: new Set(), // materials that were looked for
};

const tip = document.getElementById("tip");

const actions = {
  choose(first, second) {
    Object.assign(state, {first, second});
    draw();
  },
  /** The material becomes the second of the pair, the second the first. */
  chooseNext(material) {
    if (material !== state.second) actions.choose(state.second, material);
  },
  showTip(x, y, lines) {
    tip.replaceChildren(...lines.map((line) => element("div", {}, line)));
    tip.hidden = false;
    const {width, height} = tip.getBoundingClientRect();
    tip.style.left = `${Math.max(4, Math.min(x + 14, innerWidth - width - 8))}px`;
    tip.style.top = `${y + 18 + height > innerHeight ? Math.max(4, y - height - 12) : y + 18}px`;
  },
  hideTip() {
    tip.hidden = true;
  },
};

const views = [new Matrix(actions), new MaterialMap(actions), new Tree(actions)];

/** What the page shows, behind the # of its address: the measure and the pair by their names. */
function shown(state) {
  const names = {distance: study.measures[state.measure].name, first: study.materials[state.first].name,
    second: study.materials[state.second].name};
  return `#${new URLSearchParams(names)}`;
}

/** The address of this page with the measure and the pair. */
function pairAddress(state) {
  return location.href.replace(/#.*$/, "") + shown(state);
}

/** Shows what the address names; names that the study does not have are left out. */
function followAddress() {
  const wanted = new URLSearchParams(location.hash.slice(1));
  const indexOf = (list, name, otherwise) => {
    const index = list.findIndex((entry) => entry.name === wanted.get(name));
    return index < 0 ? otherwise : index;
  };
  state.first = indexOf(study.materials, "first", state.first);
  state.second = indexOf(study.materials, "second", state.second);
  const measure = indexOf(study.measures, "distance", state.measure);
  document.getElementById("measure").value = String(measure);
  chooseMeasure(measure);
}

function draw() {
  history.replaceState(null, "", shown(state));
  drawFamilies();
  for (const view of views) view.draw(state);
  drawMatrixCommand(state);
  drawPair(state, actions);
  drawNeighbours(state, actions);
  drawApproximations(state, actions);
}

function drawFamilies() {
  const list = document.getElementById("families");
  list.replaceChildren(...study.families.map((name, family) => {
    const members = study.materials.flatMap((material, index) => (material.family === family ? [index] : []));
    const isFound = members.length === state.matches.size && members.every((member) => state.matches.has(member));
    const symbol = d3.create("svg").attr("width", 14).attr("height", 14).attr("viewBox", "-7 -7 14 14");
    symbol.append("path").attr("d", familySymbol(family, 64)).attr("fill", familyColour(family));
    return element("li", {}, element("button", {
      type: "button",
      "aria-pressed": String(isFound),
      onclick: () => find(isFound ? "" : name, new Set(isFound ? [] : members)),
    }, symbol.node(), `${name} (${members.length})`));
  }));
}

/** Highlights materials. \param text what stands in the search box */
function find(text, matches) {
  document.getElementById("search").value = text;
  state.matches = matches;
  document.getElementById("matches").textContent = text === "" ? "" : counted(matches.size, "material");
  draw();
}

function search(text) {
  const wanted = text.trim().toLowerCase();
  const isMatch = (material, index) =>
    material.name.toLowerCase().includes(wanted) || familyOf(index).toLowerCase().includes(wanted);
  const found = study.materials.flatMap((material, index) => (isMatch(material, index) ? [index] : []));
  find(text, new Set(wanted === "" ? [] : found));
}

/** A measure, with the scale that suits it. */
function chooseMeasure(index) {
  state.measure = index;
  const measure = study.measures[index];
  state.scale = measure.spansDecades() ? "log" : "linear";
  document.getElementById("scale").value = state.scale;
  const unresolved = measure.unresolved_pairs === 0 ? ""
    : ` ${measure.unresolved_pairs} pairs did not reach the tolerance; their errors say so.`;
  document.getElementById("definition").textContent = (measure.is_lighting
    ? `Distances under ${measure.name} lighting: ${measure.definition}.`
    : `Distances by ${measure.name}.`) + (measure.origin === null ? "" : ` Where the study asks for it: ${measure.origin}.`) +
    unresolved;
  draw();
}

const wantsDark = matchMedia("(prefers-color-scheme: dark)");
let wantedTheme = "auto";

function applyTheme() {
  const isDark = wantedTheme === "auto" ? wantsDark.matches : wantedTheme === "dark";
  document.documentElement.dataset.theme = isDark ? "dark" : "light";
  document.getElementById("theme").textContent = `Theme: ${wantedTheme}`;
}

function wire() {
  const choice = document.getElementById("measure");
  for (const [label, isLighting] of [["lightings", true], ["comparison metrics", false]]) {
    const options = study.measures.flatMap((measure, index) =>
      (measure.is_lighting === isLighting ? [element("option", {value: index}, measure.name)] : []));
    if (options.length > 0) choice.append(element("optgroup", {label}, ...options));
  }
  choice.addEventListener("change", () => chooseMeasure(Number(choice.value)));
  for (const key of ["order", "scale"]) {
    document.getElementById(key).addEventListener("change", (event) => {
      state[key] = event.target.value;
      draw();
    });
  }
  const names = [...study.families, ...study.materials.map((material) => material.name)];
  document.getElementById("names").append(...names.map((value) => element("option", {value})));
  document.getElementById("search").addEventListener("input", (event) => search(event.target.value));
  document.getElementById("theme").addEventListener("click", () => {
    const themes = ["auto", "light", "dark"];
    wantedTheme = themes[(themes.indexOf(wantedTheme) + 1) % themes.length];
    applyTheme();
    draw();
  });
  addEventListener("hashchange", followAddress);
  wantsDark.addEventListener("change", () => {
    applyTheme();
    draw();
  });
  let width = innerWidth;
  addEventListener("resize", () => {
    // On phones the height changes with every scroll.
    if (innerWidth === width) return;
    width = innerWidth;
    draw();
  });
}

document.getElementById("summary").textContent =
  `${counted(study.materials.length, "material")}, ${counted(study.families.length, "family", "families")}, ` +
  `${counted(study.measures.length, "distance")}, ` +
  `computed ${study.provenance.created.slice(0, 10)} by ${study.provenance.software}`;
applyTheme();
wire();
drawAgreement();
drawProvenance();
followAddress();

"use strict";
// After the scripts of the page: what a reader does, and what is seen then.

const seen = {};
const at = (id) => document.getElementById(id);

/** At the middle of a cell of the matrix. */
function pointer(type, row, column) {
  const box = at("marks").getBoundingClientRect();
  const [matrix] = views;
  at("marks").dispatchEvent(new PointerEvent(type, {
    bubbles: true,
    clientX: box.left + matrix.left + (column + 0.5) * matrix.cell,
    clientY: box.top + matrix.top + (row + 0.5) * matrix.cell,
  }));
}

function press(key) {
  at("marks").dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
}

function select(id, value) {
  at(id).value = value;
  at(id).dispatchEvent(new Event("change"));
}

const count = (what) => document.querySelectorAll(what).length;
const pairNames = () => [...document.querySelectorAll(".side h3")].map((head) => head.textContent.trim());
const pairNotes = () => [...document.querySelectorAll(".side .note")].map((note) => note.textContent);
const pairCode = () => document.querySelector("#pair code").textContent;
const pairDistance = () => document.querySelector("#pair td:nth-child(2)").textContent;
const paper = () => getComputedStyle(document.body).backgroundColor;

async function read() {
  seen.title = document.title;
  seen.heading = document.querySelector("h1").textContent;
  seen.theme = document.documentElement.dataset.theme;

  pointer("pointermove", 3, 0);
  seen.tip = {isHidden: at("tip").hidden, text: at("tip").innerText};
  pointer("click", 3, 1);
  seen.clicked = {names: pairNames(), notes: pairNotes(), code: pairCode(), distance: pairDistance()};
  document.querySelector("#pair .command button").click();
  await Promise.resolve();
  seen.copied = copied.slice();
  at("pair-link").click();
  await Promise.resolve();
  seen.link = copied[1];
  const pictures = [...document.querySelectorAll("#pair .sphere")];
  await Promise.all(pictures.map((picture) => picture.decode()));
  seen.spheres = {widths: pictures.map((picture) => picture.naturalWidth), nearest: count("#neighbours .sphere")};
  seen.curves = {albedos: count("#pair .albedo"), slices: count("#pair .slice")};

  at("marks").focus();
  press("ArrowUp");
  press("ArrowUp");
  press("ArrowLeft");
  seen.keyboard = {cell: at("cell").textContent};
  press("Enter");
  seen.keyboard.chosen = pairNames();

  const savedBy = async (button) => {
    document.querySelector(button).click();
    return saved.at(-1).text();
  };
  seen.distances = await savedBy("#matrix-commands .csv");
  seen.residuals = await savedBy("#approximation-tables .csv");
  seen.csv = csvText([["a,b", 'c"d', 1.5, NaN]]);

  const before = at("cells").toDataURL();
  select("measure", "1");
  const isRepainted = at("cells").toDataURL() !== before;
  seen.daylight = {definition: at("definition").textContent, code: pairCode(), isRepainted};
  select("measure", "2");
  seen.comparison = {code: pairCode(), leaves: count(".leaf")};
  select("measure", "0");
  select("order", "tree");
  seen.order = views[0].sequence;
  select("scale", "log");
  seen.scale = at("tree-note").textContent;

  at("search").value = "met";
  at("search").dispatchEvent(new Event("input"));
  seen.found = {text: at("matches").textContent, materials: [...state.matches]};
  document.querySelector("#families button").click();
  seen.family = {search: at("search").value, pressed: document.querySelector('[aria-pressed="true"]').textContent};
  document.querySelectorAll(".material")[2].dispatchEvent(new MouseEvent("click"));
  seen.hostile = pairNames()[1];

  seen.neighbours = count("#neighbour-tables tbody tr");
  seen.approximations = count("#approximation-tables tbody tr");
  seen.agreement = count("#agreement-tables tbody tr");
  seen.provenance = at("provenance-list").textContent;
  seen.study = at("study-file").textContent;
  const followed = new Promise((resolve) => addEventListener("hashchange", resolve));
  location.hash = seen.link.slice(seen.link.indexOf("#"));
  await followed;
  seen.linked = {names: pairNames(), distance: pairDistance(), measure: at("measure").value};
  location.hash = "#distance=none&first=nobody";
  await new Promise((resolve) => addEventListener("hashchange", resolve));
  seen.unknownLink = pairNames();

  seen.tallestHead = Math.max(...[...document.querySelectorAll("th")].map((head) => head.getBoundingClientRect().height));
  const {scrollWidth, clientWidth} = document.documentElement;
  seen.isTooWide = scrollWidth > clientWidth;
  seen.papers = [paper()];
  for (let click = 0; click < 2; ++click) {
    at("theme").click();
    seen.papers.push(paper());
  }
  seen.numbers = printedNumbers.map(([value, digits]) => general(value, digits));
  seen.estimates = [[0.56751271234, 1.8e-7], [1, 0], [2, NaN], [NaN, 1], [0.001, 0.1]]
    .map(([value, error]) => estimateText(value, error));
}

read().catch((error) => failures.push(String(error))).finally(() => {
  seen.failures = failures;
  seen.hacked = globalThis.hacked;
  const outcome = document.createElement("pre");
  outcome.id = "outcome";
  outcome.textContent = JSON.stringify(seen);
  document.body.append(outcome);
  if (parent !== window) parent.postMessage(outcome.textContent, "*");
});

"use strict";
// The chosen material in a scene, by path tracing: the server adds samples as long as nothing else is asked for.

const sceneEdge = 240; // of the picture, pixels
const sceneDraftEdge = 80;
const sceneSamples = [16, 64, 256, 1024];
const sceneDraftSamples = 2;
let sceneAsked = 0;
let scenePicture = null;

const chosenScene = () => catalogue.scenes[state.scene.index];
const sceneReplaced = () => chosenScene().materials[state.scene.replaced];

/** What a link says of the scene, as far as it makes sense for the scenes that there are. */
function sceneOf(read) {
  const isIndex = (value, list) => Number.isInteger(value) && value >= 0 && value < list.length;
  const index = isIndex(read?.index, catalogue.scenes) ? read.index : 0;
  const { materials, replaced } = catalogue.scenes[index];
  return {
    draw: typeof read?.draw === "boolean" ? read.draw : catalogue.has_given_scene,
    index,
    replaced: isIndex(read?.replaced, materials) ? read.replaced : replaced,
    samples: sceneSamples.includes(read?.samples) ? read.samples : 64,
  };
}

/** Its width with no edge above a length, pixels. */
function sceneWidth(scene, edge) {
  const [width, height] = scene.size;
  return Math.max(1, Math.floor(Math.min(width, edge, (edge * width) / height)));
}

function fillScenes() {
  $("scene-choice").replaceChildren(...catalogue.scenes.map((one, i) => new Option(one.name, i)));
  $("scene-samples").replaceChildren(...sceneSamples.map((one) => new Option(one)));
}

function showSceneChoices() {
  const { scene } = state;
  $("scene-draw").checked = scene.draw;
  $("scene-choice").value = scene.index;
  const names = chosenScene().materials;
  $("scene-replaced").replaceChildren(...names.map((name, i) => new Option(name, i, false, name === sceneReplaced())));
  $("scene-samples").value = scene.samples;
  $("save-scene-file").disabled = chosenScene().text === "";
}

/** What the command takes to draw the picture that is shown when all samples are there. */
function sceneCommand() {
  const scene = chosenScene();
  const material = wordOf(state.materials[state.selected]);
  return `lobe render ${shellWord(scene.word)} --replace ${shellWord(`${sceneReplaced()}=${material}`)} ` +
    `--width ${sceneWidth(scene, sceneEdge)} --samples ${state.scene.samples} -o scene.png`;
}

function tellScene(answer, wanted, material) {
  const goes = answer.samples < wanted ? `of ${wanted} ` : "";
  $("scene-note").textContent = `${nameOf(material)}: ${answer.samples} ${goes}samples in each of ${answer.width} × ${answer.height} pixels; ` +
    `noise ${general(100 * number(answer.noise), 2)} % of the mean radiance, whose luminance is ${told(answer.mean_luminance)}; ` +
    `exposure × ${general(answer.exposure, 3)}.`;
}

/** No picture, and why not. */
function hideScene(reason) {
  document.body.dataset.drawing = "0";
  scenePicture = null;
  $("scene-picture").hidden = true;
  $("scene-note").textContent = reason;
  $("save-scene").disabled = true;
}

function showScene() {
  sceneAsked += 1;
  showSceneChoices();
  if (!state.scene.draw) {
    forget("scene");
    hideScene("");
    return;
  }
  document.body.dataset.drawing = "1";
  const mark = sceneAsked;
  const scene = chosenScene();
  const replaced = sceneReplaced();
  const material = state.materials[state.selected];
  const isDraft = isInGesture;
  const width = sceneWidth(scene, isDraft ? sceneDraftEdge : sceneEdge);
  const wanted = isDraft ? sceneDraftSamples : state.scene.samples;
  const question = { scene: state.scene.index, replaced: state.scene.replaced, material, width };
  // The first picture is asked for with as few samples as there can be.
  const more = (samples) => ask("scene", "scene", { ...question, samples }, (answer, error) => {
    if (mark !== sceneAsked) return;
    if (error !== null) {
      hideScene(`${nameOf(material)}: ${error.message}`);
      return;
    }
    const picture = $("scene-picture");
    picture.hidden = false;
    picture.src = `data:image/png;base64,${answer.png}`;
    picture.alt = `${scene.name}, with ${nameOf(material)} in place of ${replaced}`;
    scenePicture = { replaced, material, samples: answer.samples, png: answer.png };
    $("save-scene").disabled = false;
    tellScene(answer, wanted, material);
    if (answer.samples < wanted) more(wanted);
    else if (!isDraft) document.body.dataset.drawing = "0";
  }, true, true);
  more(2);
}

function savePicture() {
  if (scenePicture === null) return;
  const bytes = Uint8Array.from(atob(scenePicture.png), (letter) => letter.charCodeAt(0));
  save("scene.png", new Blob([bytes], { type: "image/png" }));
}

function listenToScene() {
  onChoice("scene-draw", (now, value) => { now.scene.draw = value; });
  onChoice("scene-choice", (now, value) => {
    now.scene.index = Number(value);
    now.scene.replaced = catalogue.scenes[now.scene.index].replaced;
  });
  onChoice("scene-replaced", (now, value) => { now.scene.replaced = Number(value); });
  onChoice("scene-samples", (now, value) => { now.scene.samples = Number(value); });
  $("save-scene").addEventListener("click", savePicture);
  $("save-scene-file").addEventListener("click", () => save(chosenScene().word, chosenScene().text, "text/plain"));
}

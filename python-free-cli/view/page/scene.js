"use strict";
// The chosen material in a scene, by path tracing: the server adds samples as long as nothing else is asked for.

const sceneWidth = 240;
const sceneDraftWidth = 80;
const sceneDraftSamples = 2;
let sceneAsked = 0;
let scenePicture = null;

const chosenScene = () => catalogue.scenes[state.scene.index] ?? catalogue.scenes[0];
const sceneReplaced = () => chosenScene().materials[state.scene.replaced] ?? chosenScene().materials[chosenScene().replaced];

function fillScenes() {
  $("scene-choice").replaceChildren(...catalogue.scenes.map((one, i) => new Option(one.name, i)));
}

function showSceneChoices() {
  const { scene } = state;
  $("scene-draw").checked = scene.draw;
  $("scene-choice").value = scene.index;
  const names = chosenScene().materials;
  $("scene-replaced").replaceChildren(...names.map((name, i) => new Option(name, i, false, name === sceneReplaced())));
  $("scene-samples").value = scene.samples;
  $("save-scene-file").disabled = chosenScene().text === "";
  $("save-scene").disabled = scenePicture === null;
}

/** What the command takes to draw the same picture. */
function sceneCommand() {
  if (scenePicture === null) return "";
  const { scene, replaced, material, width, samples } = scenePicture;
  return `lobe render ${shellWord(scene.word)} --replace ${shellWord(`${replaced}=${wordOf(material)}`)} ` +
    `--width ${width} --samples ${samples} -o scene.png`;
}

function tellScene(answer, wanted) {
  const mean = [0.2126, 0.7152, 0.0722].reduce((sum, share, c) => ({
    value: sum.value + share * number(answer.mean_radiance[c].value),
    error: sum.error + share * number(answer.mean_radiance[c].error),
  }), { value: 0, error: 0 });
  const goes = answer.samples < wanted ? `of ${wanted} ` : "";
  $("scene-note").textContent = `${answer.samples} ${goes}samples in each of ${answer.width} × ${answer.height} pixels; ` +
    `noise ${general(100 * number(answer.noise), 2)} % of the mean radiance, whose luminance is ${told(mean)}; ` +
    `exposure × ${general(answer.exposure, 3)}.`;
}

function showScene() {
  sceneAsked += 1;
  showSceneChoices();
  const { draw, index } = state.scene;
  document.body.dataset.drawing = draw ? "1" : "0";
  if (!draw) {
    forget("scene");
    return;
  }
  const mark = sceneAsked;
  const scene = chosenScene();
  const replaced = sceneReplaced();
  const material = state.materials[state.selected];
  const isDraft = isInGesture;
  const width = isDraft ? sceneDraftWidth : Math.min(sceneWidth, scene.width);
  const wanted = isDraft ? sceneDraftSamples : state.scene.samples;
  const question = { scene: Math.min(index, catalogue.scenes.length - 1), replaced: scene.materials.indexOf(replaced), material, width };
  // The first picture is asked for with as few samples as there can be.
  const more = (samples) => ask("scene", "scene", { ...question, samples }, (answer, error) => {
    if (mark !== sceneAsked) return;
    if (error !== null) {
      document.body.dataset.drawing = "0";
      scenePicture = null;
      $("scene-picture").hidden = true;
      $("scene-note").textContent = `${nameOf(material)}: ${error.message}`;
      showSceneChoices();
      return;
    }
    const picture = $("scene-picture");
    picture.hidden = false;
    picture.src = `data:image/png;base64,${answer.png}`;
    picture.alt = `${scene.name}, with ${nameOf(material)} in place of ${replaced}`;
    scenePicture = { scene, replaced, material, width, samples: answer.samples, png: answer.png };
    tellScene(answer, wanted);
    showSceneChoices();
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

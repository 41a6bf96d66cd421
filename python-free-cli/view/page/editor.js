"use strict";
// A material as a form: its terms with their factors, its adjustments, and the specification that all of them make.

let catalogue = null;
let edited = null; // the formula in the form
let editedText = null; // the text it stands for

const modelOf = (name) => catalogue.models.find((one) => one.name === name);
const factorOf = (name) => catalogue.factors.find((one) => one.name === name);

/** The specification of a formula, as parse_material() reads it. */
function specificationOf(formula) {
  const values = (parameters) => Object.entries(parameters).map(([key, value]) => `${key}=${value}`);
  const terms = formula.terms.map((term) => {
    const words = values(term.parameters);
    if (term.weight.length > 1 || term.weight[0] !== 1) words.push(`scale=${term.weight.join("/")}`);
    let text = term.model + (words.length > 0 ? `:${words.join(",")}` : "");
    for (const factor of term.factors ?? []) {
      const own = values(factor.parameters);
      text += `*${factor.name}${own.length > 0 ? `:${own.join(",")}` : ""}`;
    }
    return text;
  });
  return terms.join("+") + formula.adjustments.map((one) => `@${one}`).join("");
}

/** A parameter's place on a slider from 0 to 1, and back; logarithmic over wide ranges. */
function scaleOf(parameter) {
  const typical = Math.abs(parameter.typical) || 1;
  const low = parameter.minimum;
  const high = number(parameter.maximum) === Infinity ? Math.max(typical * 100, low + 1) : number(parameter.maximum);
  const isLogarithmic = low >= 0 && (low > 0 ? high / low > 100 : number(parameter.maximum) === Infinity);
  if (!isLogarithmic) {
    return { place: (value) => (value - low) / (high - low), value: (place) => low + place * (high - low) };
  }
  const first = low > 0 ? low : typical / 1000;
  const span = Math.log(high / first);
  return {
    place: (value) => (value <= first ? 0 : Math.log(value / first) / span),
    value: (place) => (place <= 0 ? low : first * Math.exp(place * span)),
  };
}

const fourDigits = (value) => Number(value.toPrecision(4));

/** One line of the form. `set(value)` changes the formula. */
function parameterLine(id, parameter, value, set) {
  const line = document.createElement("div");
  line.className = "parameter";
  const label = document.createElement("label");
  label.textContent = parameter.unit === "1" ? parameter.name : `${parameter.name}, ${parameter.unit}`;
  label.htmlFor = id;
  label.title = parameter.description;
  const scale = scaleOf(parameter);
  const slider = document.createElement("input");
  Object.assign(slider, { type: "range", min: 0, max: 1, step: "any", id, title: parameter.description });
  slider.step = 0.001;
  slider.value = scale.place(value);
  const field = document.createElement("input");
  Object.assign(field, { type: "number", step: "any", value });
  field.setAttribute("aria-label", `${parameter.name}, as a number`);
  slider.addEventListener("input", () => {
    const chosen = fourDigits(scale.value(Number(slider.value)));
    field.value = chosen;
    set(chosen, true);
  });
  slider.addEventListener("change", endGesture);
  field.addEventListener("change", () => {
    if (field.value === "" || !Number.isFinite(Number(field.value))) return;
    slider.value = scale.place(Number(field.value));
    set(Number(field.value), false);
  });
  line.append(label, slider, field);
  return line;
}

function choice(names, chosen, label, onChange) {
  const select = document.createElement("select");
  select.setAttribute("aria-label", label);
  for (const name of names) select.add(new Option(name, name, false, name === chosen));
  select.addEventListener("change", () => onChange(select.value));
  return select;
}

function button(text, onClick) {
  const made = document.createElement("button");
  made.type = "button";
  made.textContent = text;
  made.addEventListener("click", onClick);
  return made;
}

const typicalValues = (parameters) => Object.fromEntries(parameters.map((one) => [one.name, one.default ?? one.typical]));

/** The changed formula becomes the material; the form stays, if only numbers changed. */
function applyEdit(isGesture, isNewForm) {
  const text = specificationOf(edited);
  editedText = text;
  change((now) => { now.materials[now.selected] = text; }, isGesture);
  document.getElementById("specification").value = text;
  if (isNewForm) drawTerms();
}

function drawTerms() {
  const box = document.getElementById("terms");
  box.replaceChildren();
  if (edited === null) return;
  const white = { name: "scale", unit: "1", minimum: 0, maximum: 1, typical: 1, description: "factor on the term" };
  edited.terms.forEach((term, t) => {
    const model = modelOf(term.model);
    const set = document.createElement("fieldset");
    const legend = document.createElement("legend");
    legend.append(choice(catalogue.models.map((one) => one.name), term.model, `model of term ${t + 1}`, (name) => {
      edited.terms[t] = { ...term, model: name, parameters: typicalValues(modelOf(name).parameters) };
      applyEdit(false, true);
    }));
    if (edited.terms.length > 1) {
      legend.append(" ", button("Remove", () => {
        edited.terms.splice(t, 1);
        applyEdit(false, true);
      }));
    }
    set.append(legend);
    const source = document.createElement("p");
    source.className = "note";
    source.textContent = `f = ${model.formula}`;
    source.title = model.source;
    set.append(source);
    model.parameters.forEach((parameter, p) => {
      set.append(parameterLine(`p-${t}-${p}`, parameter, term.parameters[parameter.name], (value, isGesture) => {
        term.parameters[parameter.name] = value;
        applyEdit(isGesture, false);
      }));
    });
    term.weight.forEach((weight, c) => {
      const named = term.weight.length > 1 ? { ...white, name: `scale, channel ${c + 1}` } : white;
      set.append(parameterLine(`w-${t}-${c}`, named, weight, (value, isGesture) => {
        term.weight[c] = value;
        applyEdit(isGesture, false);
      }));
    });
    const colourful = button(term.weight.length > 1 ? "One scale for all channels" : "A scale for red, green and blue", () => {
      term.weight = term.weight.length > 1 ? [term.weight[0]] : [term.weight[0], term.weight[0], term.weight[0]];
      applyEdit(false, true);
    });
    (term.factors ?? []).forEach((factor, f) => {
      const head = document.createElement("div");
      head.className = "row";
      head.append(`times ${factor.name} `, button("Remove", () => {
        term.factors.splice(f, 1);
        applyEdit(false, true);
      }));
      set.append(head);
      factorOf(factor.name).parameters.forEach((parameter, p) => {
        set.append(parameterLine(`f-${t}-${f}-${p}`, parameter, factor.parameters[parameter.name], (value, isGesture) => {
          factor.parameters[parameter.name] = value;
          applyEdit(isGesture, false);
        }));
      });
    });
    const factors = choice(["times a factor …", ...catalogue.factors.map((one) => one.name)], "", `factor for term ${t + 1}`, (name) => {
      if (factorOf(name) === undefined) return;
      term.factors = [...(term.factors ?? []), { name, parameters: typicalValues(factorOf(name).parameters) }];
      applyEdit(false, true);
    });
    const row = document.createElement("div");
    row.className = "buttons";
    row.append(colourful, factors);
    set.append(row);
    box.append(set);
  });
  const adjustments = document.createElement("div");
  adjustments.className = "row";
  edited.adjustments.forEach((one, a) => {
    adjustments.append(`@${one} `, button("Remove", () => {
      edited.adjustments.splice(a, 1);
      applyEdit(false, true);
    }));
  });
  const possible = ["normalise", "pump", "pump:correction=g2,times=2", "pump:correction=controlled,times=2", "mirror", "kulla_conty", "turquin"];
  adjustments.append(choice(["adjust as a whole …", ...possible], "", "adjustment of the whole", (name) => {
    if (!possible.includes(name)) return;
    edited.adjustments.push(name);
    applyEdit(false, true);
  }));
  box.append(adjustments);
}

/** Shows the selected material in the form, unless the form made it. */
function showEdited(text, answer) {
  const field = document.getElementById("specification");
  const isFormula = answer.formula !== undefined;
  document.getElementById("save-toml").disabled = !isFormula;
  document.getElementById("add-term").disabled = !isFormula;
  if (text === editedText) return;
  editedText = text;
  field.value = text;
  edited = isFormula && answer.is_specification ? answer.formula : null;
  drawTerms();
  if (edited === null) {
    const note = document.createElement("p");
    note.className = "note";
    note.textContent = isFormula
      ? `${answer.name}: a formula of its own, which its file tells`
      : `${answer.name}: ${answer.format}, ${counted(answer.channels, "channel")}, ${answer.colours}`;
    document.getElementById("terms").append(note);
  }
}

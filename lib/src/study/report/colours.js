"use strict";
// Colours that are told apart with any kind of sight (Okabe and Ito 2008, without its yellow and black, which one of
// the themes swallows), and symbols beside them.

const familyColours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#8c6bb1", "#8a8a8a"];
const familySymbols = [
  d3.symbolCircle, d3.symbolSquare, d3.symbolTriangle, d3.symbolDiamond, d3.symbolCross, d3.symbolStar, d3.symbolWye,
];
const angleColours = {light: ["#440154", "#2a788e", "#3fa63c"], dark: ["#b58ad0", "#3fb5c4", "#a5db36"]};

function familyColour(family) {
  return familyColours[family % familyColours.length];
}

/** Path of the symbol of a family, about the origin. */
function familySymbol(family, area) {
  return d3.symbol().type(familySymbols[family % familySymbols.length]).size(area)();
}

/** A colour of the style by its name. */
function themeColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function theme() {
  return document.documentElement.dataset.theme;
}

/** Curves by channel: what channels are called, else by number. */
function channelColour(channel) {
  const named = {
    light: {r: "#c62828", g: "#2e7d32", b: "#1565c0"},
    dark: {r: "#ff7b72", g: "#6fcf73", b: "#6cb0ff"},
  };
  const colours = named[theme()];
  const name = study.channels[channel].toLowerCase();
  if (name === "r" || name === "red") return colours.r;
  if (name === "g" || name === "green") return colours.g;
  if (name === "b" || name === "blue") return colours.b;
  return study.channels.length === 1 ? themeColour("--ink") : familyColour(channel);
}

"use strict";
// Before the scripts of the page: what goes wrong, and what is copied.

globalThis.hacked = 0;
const failures = [];
const copied = [];
addEventListener("error", (event) => failures.push(event.message));
addEventListener("unhandledrejection", (event) => failures.push(String(event.reason)));
Object.defineProperty(navigator, "clipboard", {value: {writeText: async (text) => { copied.push(text); }}});
// What is saved as a file.
const saved = [];
URL.createObjectURL = (blob) => {
  saved.push(blob);
  return "#";
};

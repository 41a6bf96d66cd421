// Search over titles, headings and text of all pages; `sections` comes from search-index.js. "/" begins a search.
"use strict";

const field = document.getElementById("search");
const results = document.getElementById("results");
const kResults = 12;
const kExcerpt = 110;

const index = sections.map(([url, page, heading, text]) => ({
  url, page, heading, text, words: [page, heading, text].map((part) => part.toLowerCase())
}));

/// How well a section answers; 0 unless all words occur in it.
function score(section, words) {
  let sum = 0;
  for (const word of words) {
    const [page, heading, text] = section.words;
    const found = (page.includes(word) ? 4 : 0) + (page === word ? 40 : 0) + (heading.includes(word) ? 8 : 0) +
                  (text.includes(word) ? 1 : 0);
    if (found === 0) return 0;
    sum += found;
  }
  return sum;
}

function excerpt(section, words) {
  const at = Math.max(0, Math.min(...words.map((word) => section.words[2].indexOf(word)).filter((i) => i >= 0), Infinity));
  const from = Number.isFinite(at) ? Math.max(0, at - 30) : 0;
  return (from > 0 ? "… " : "") + section.text.slice(from, from + kExcerpt);
}

function item(section, words) {
  const entry = document.createElement("li");
  const link = document.createElement("a");
  link.href = field.dataset.root + section.url;
  const title = document.createElement("b");
  title.textContent = section.heading === section.page ? section.page : `${section.page} › ${section.heading}`;
  const text = document.createElement("span");
  text.textContent = excerpt(section, words);
  link.append(title, text);
  entry.append(link);
  return entry;
}

function search() {
  const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
  results.hidden = words.length === 0;
  if (results.hidden) return;
  const found = index.map((section) => [score(section, words), section]).filter(([value]) => value > 0)
                     .sort(([a], [b]) => b - a).slice(0, kResults);
  results.replaceChildren(...found.map(([, section]) => item(section, words)));
  if (found.length === 0) results.innerHTML = "<li><p>Nothing found.</p></li>";
}

field.addEventListener("input", search);
field.addEventListener("focus", search);
document.addEventListener("click", (event) => { if (!event.target.closest(".search")) results.hidden = true; });
document.addEventListener("keydown", (event) => {
  const links = [...results.querySelectorAll("a")];
  const at = links.indexOf(document.activeElement);
  if (event.key === "/" && !/INPUT|TEXTAREA/.test(document.activeElement.tagName)) {
    event.preventDefault();
    field.focus();
  } else if (event.key === "Escape") {
    results.hidden = true;
    field.blur();
  } else if (!results.hidden && (event.key === "ArrowDown" || event.key === "ArrowUp") && links.length > 0) {
    event.preventDefault();
    links[(at + (event.key === "ArrowDown" ? 1 : links.length - (at < 0 ? 0 : 1))) % links.length].focus();
  } else if (event.key === "Enter" && document.activeElement === field && links.length > 0) {
    links[0].click();
  }
});

// The page that is read stays in sight in a long list of pages.
document.querySelector(".pages [aria-current]")?.scrollIntoView({block: "nearest"});

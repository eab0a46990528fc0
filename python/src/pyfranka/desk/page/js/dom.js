// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Elements of the page. Text always becomes a text node, so that no name from a robot or a user is markup.

/** Makes an element. `properties`: class, text, on: {event: handler}, data: {name: value}; others are attributes. */
export function el(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "class") element.className = value;
    else if (name === "text") element.textContent = value;
    else if (name === "on") for (const [event, handler] of Object.entries(value)) element.addEventListener(event, handler);
    else if (name === "data") Object.assign(element.dataset, value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

/** An icon of strokes, which inherits the color of the text. `paths`: values of the attribute d. */
export function icon(...paths) {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  svg.setAttribute("class", "icon");
  for (const d of paths) {
    const path = document.createElementNS(SVG, "path");
    path.setAttribute("d", d);
    svg.append(path);
  }
  return svg;
}

/** Sets a text only if it changes: 20 updates a second then cost nothing. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export function setHidden(element, hidden) {
  if (element.hidden !== hidden) element.hidden = hidden;
}

export function setAttribute(element, name, value) {
  const text = String(value);
  if (element.getAttribute(name) !== text) element.setAttribute(name, text);
}

/** Replaces the children if the key differs from that of the last call. */
export function renderIfChanged(element, key, make) {
  if (element.renderedKey === key) return;
  element.renderedKey = key;
  element.replaceChildren(...make());
}

let numbers = 0;
/** A name for `id`, `for` and `aria-labelledby`. */
export function uniqueId(prefix) {
  numbers += 1;
  return `${prefix}-${numbers}`;
}

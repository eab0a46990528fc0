// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Light or dark: the setting of the system, unless the user has chosen.

const KEY = "desk-theme";
const CHOICES = ["auto", "light", "dark"];
const listeners = [];

function read() {
  const chosen = localStorage.getItem(KEY);
  return CHOICES.includes(chosen) ? chosen : "auto";
}

function apply(choice) {
  if (choice === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = choice;
  for (const listener of listeners) listener();
}

export const choice = read;

/** Selects the next of auto, light and dark, and returns it. */
export function nextTheme() {
  const next = CHOICES[(CHOICES.indexOf(read()) + 1) % CHOICES.length];
  localStorage.setItem(KEY, next);
  apply(next);
  return next;
}

/** Calls back when colors have changed, for what is drawn on a canvas. */
export function onColors(listener) {
  listeners.push(listener);
}

/** The value of a color of css/theme.css, such as "--text". */
export function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function startTheme() {
  apply(read());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => apply(read()));
}

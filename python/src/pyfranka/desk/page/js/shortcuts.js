// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Shortcuts: single letters, inactive in fields and dialogs. The user can switch them off (WCAG
// 2.1.4).

const KEY = "desk-shortcuts";

export const shortcutsOn = () => localStorage.getItem(KEY) !== "off";
export const switchShortcuts = (on) => localStorage.setItem(KEY, on ? "on" : "off");

export const SHORTCUTS = [
  ["s", "Press the user stop of all robots"],
  ["u", "Unlock the joints of the selected robot"],
  ["l", "Lock its joints"],
  ["f", "Switch its FCI on or off"],
  ["g", "Begin or end guiding"],
  ["r", "Recover from errors"],
  ["c", "Take or release control"],
  ["v", "Go to the 3D view"],
  ["1 – 9", "Select a robot"],
  ["t", "Change the colors: automatic, light, dark"],
  ["?", "Show this list"],
];

function inField(target) {
  return target.closest?.("input, select, textarea, dialog, [contenteditable]");
}

/** handlers: key -> function. */
export function listenForShortcuts(handlers) {
  document.addEventListener("keydown", (event) => {
    if (!shortcutsOn() || event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
    if (inField(event.target) || document.querySelector("dialog[open]")) return;
    const handler = handlers[event.key];
    if (!handler) return;
    event.preventDefault();
    handler();
  });
}

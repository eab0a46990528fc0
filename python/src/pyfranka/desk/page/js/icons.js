// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The icons of the page, drawn here: 24 x 24, strokes only.
import { icon } from "./dom.js";

export const locked = () => icon("M7 11V8a5 5 0 0 1 10 0v3", "M5 11h14v9H5z");
export const unlocked = () => icon("M7 11V8a5 5 0 0 1 9.6-2", "M5 11h14v9H5z");
export const stop = () => icon("M8 3h8l5 5v8l-5 5H8l-5-5V8z", "M9 12h6");
export const help = () => icon("M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18z", "M9.5 9.5a2.5 2.5 0 1 1 3.5 2.3c-.7.3-1 .8-1 1.7", "M12 16.8v.1");
export const theme = () => icon("M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18z", "M12 3a9 9 0 0 1 0 18z");
export const leave = () => icon("M10 4H5v16h5", "M9 12h11", "M16 8l4 4-4 4");
export const circle = () => icon("M12 18a6 6 0 1 0 0-12 6 6 0 0 0 0 12z");
export const cross = () => icon("M7 7l10 10", "M17 7L7 17");
export const check = () => icon("M5 13l5 5L19 7");
export const up = () => icon("M12 19V5", "M6 11l6-6 6 6");
export const down = () => icon("M12 5v14", "M6 13l6 6 6-6");
export const left = () => icon("M19 12H5", "M11 6l-6 6 6 6");
export const right = () => icon("M5 12h14", "M13 6l6 6-6 6");
export const warning = () => icon("M12 4L2.5 20h19z", "M12 10v4", "M12 17v.1");

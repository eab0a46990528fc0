// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Numbers as text, with a true minus sign and digits that do not jump.

const MINUS = "\u2212";

export function number(value, digits) {
  if (!Number.isFinite(value)) return "–";
  const text = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(text) !== 0 ? MINUS : "") + text;
}

export const degrees = (radians) => `${number((radians * 180) / Math.PI, 1)}°`;

/** A duration in the two largest units: "23 h 59 min". */
export function duration(seconds) {
  const left = Math.max(0, Math.round(seconds));
  const [hours, minutes] = [Math.floor(left / 3600), Math.floor((left % 3600) / 60)];
  if (hours) return `${hours} h ${minutes} min`;
  if (minutes) return `${minutes} min ${left % 60} s`;
  return `${left} s`;
}

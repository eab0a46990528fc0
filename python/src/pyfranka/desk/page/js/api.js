// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Requests to Desk. All go to the host of the page.

/** A request that Desk or the robot has refused; `message` is its sentence, `code` a word such as BrakesClosed. */
export class Refusal extends Error {
  constructor(status, body) {
    super(body.message || body.error || `Desk has answered with status ${status}.`);
    this.status = status;
    this.code = body.code || "";
  }
}

async function answered(response) {
  const text = await response.text();
  let body = {};
  try {
    body = text ? JSON.parse(text) : {};
  } catch {
    body = { message: text };
  }
  if (!response.ok) throw new Refusal(response.status, body);
  return body;
}

async function reach(path, options) {
  try {
    return await fetch(path, { credentials: "same-origin", cache: "no-store", ...options });
  } catch {
    throw new Refusal(0, { message: "Desk does not answer. Is franka_desk still running?" });
  }
}

export async function get(path) {
  return answered(await reach(path, {}));
}

// Meshes: the browser may keep them.
async function getFile(path) {
  const response = await reach(path, { cache: "default" });
  if (!response.ok) await answered(response);
  return response;
}

export const getBytes = async (path) => (await getFile(path)).arrayBuffer();
export const getText = async (path) => (await getFile(path)).text();

export async function post(path, body = {}, token = "") {
  const headers = { "Content-Type": "application/json" };
  if (token) headers["X-Control-Token"] = token;
  return answered(await reach(path, { method: "POST", headers, body: JSON.stringify(body) }));
}

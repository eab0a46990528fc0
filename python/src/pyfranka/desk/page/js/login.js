// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The login.
import * as api from "./api.js";
import { el, setText, uniqueId } from "./dom.js";

function field(label, type, autocomplete) {
  const id = uniqueId("login");
  const input = el("input", { id, type, autocomplete, required: true, spellcheck: "false", autocapitalize: "off" });
  return { input, element: el("div", { class: "field" }, el("label", { for: id, text: label }), input) };
}

/** Shows the form; resolves when the login was accepted. reason: a sentence above it, or empty. */
export function showLogin(place, reason = "") {
  return new Promise((resolve) => {
    const user = field("User", "text", "username");
    const password = field("Password", "password", "current-password");
    const problem = el("p", { class: "problem", role: "alert", hidden: true });
    const submit = el("button", { type: "submit", class: "primary", text: "Log in" });
    const send = async (event) => {
      event.preventDefault();
      submit.disabled = true;
      try {
        resolve(await api.post("/page/login", { user: user.input.value, password: password.input.value }));
      } catch (refusal) {
        setText(problem, refusal.message);
        problem.hidden = false;
        password.input.select();
      } finally {
        submit.disabled = false;
      }
    };
    const form = el("form", { class: "login card", on: { submit: send } },
      el("h1", { text: "Desk" }),
      el("p", { class: "state", text: reason || "Log in to watch and operate the robots." }),
      user.element, password.element, problem, submit);
    place.replaceChildren(form);
    user.input.focus();
  });
}

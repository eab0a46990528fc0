// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The stream of the robots' states. It reconnects automatically.
import * as api from "./api.js";

const MAX_PAUSE = 5000; // [ms] between two attempts
const LOGIN_ENDED = 4401; // close code: the login is no longer valid

export class Live {
  /** onFrame(frame), onConnection(connected), onLoginEnded(). */
  constructor({ onFrame, onConnection, onLoginEnded }) {
    this.handlers = { onFrame, onConnection, onLoginEnded };
    this.pause = 500;
    this.ended = false;
    this.connect();
  }

  // A refused WebSocket gives no reason, so this requests whether the login is still valid.
  async connectAgain() {
    if (this.ended) return;
    try {
      const { user } = await api.get("/page/session");
      if (this.ended) return;
      if (user) this.connect();
      else this.handlers.onLoginEnded();
    } catch {
      this.wait();
    }
  }

  wait() {
    setTimeout(() => this.connectAgain(), this.pause);
    this.pause = Math.min(2 * this.pause, MAX_PAUSE);
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    this.socket = new WebSocket(`${scheme}//${location.host}/page/live`);
    this.socket.addEventListener("open", () => {
      if (this.ended) {
        this.socket.close();
        return;
      }
      this.pause = 500;
      this.handlers.onConnection(true);
    });
    this.socket.addEventListener("message", (event) => this.handlers.onFrame(JSON.parse(event.data)));
    this.socket.addEventListener("close", (event) => this.onClose(event));
  }

  onClose(event) {
    if (this.ended) return;
    this.handlers.onConnection(false);
    if (event.code === LOGIN_ENDED) {
      this.handlers.onLoginEnded();
      return;
    }
    this.wait();
  }

  end() {
    this.ended = true;
    // Browsers report an error if a connecting socket is closed. Its handler of "open" closes it then.
    if (this.socket.readyState === WebSocket.OPEN) this.socket.close();
  }
}

// One WebSocket that comes back: what it says is handed on, what breaks it is told.

const FIRST_PAUSE = 250, LONGEST_PAUSE = 5000, GROWTH = 1.7;

/** Where the server's socket is, from where the page is. */
const socketAddress = () => `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`;

export class Connection {
  /**
   * `told` has what is called: `state(name, seconds)` with "connecting", "open" or "lost"; `message(object)`;
   * `frame(buffer)`; `broken(text)` for what cannot be read.
   */
  constructor(told, address = socketAddress()) {
    Object.assign(this, { told, address, socket: null, pause: FIRST_PAUSE, timer: 0, ended: false });
    this.again = () => { if (this.socket === null && !this.ended) this.connect(); };
    addEventListener("online", this.again);
    this.connect();
  }

  connect() {
    clearTimeout(this.timer);
    this.told.state("connecting", 0);
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.addEventListener("open", () => {
      if (this.ended) { socket.close(); return; }
      this.pause = FIRST_PAUSE;
      this.told.state("open", 0);
    });
    socket.addEventListener("message", ({ data }) => { if (socket === this.socket && !this.ended) this.receive(data); });
    socket.addEventListener("close", () => {
      if (socket !== this.socket) return;
      this.socket = null;
      if (this.ended) return;
      this.told.state("lost", this.pause / 1000);
      this.timer = setTimeout(this.again, this.pause);
      this.pause = Math.min(this.pause * GROWTH, LONGEST_PAUSE);
    });
  }

  /** Whatever comes, the page goes on: what cannot be read or used is told as such. */
  receive(data) {
    try {
      if (typeof data !== "string") { this.told.frame(data); return; }
      const message = JSON.parse(data);
      if (message === null || typeof message !== "object" || typeof message.is !== "string") {
        throw new Error("a message does not say what it is");
      }
      this.told.message(message);
    } catch (error) {
      this.told.broken(error.message);
    }
  }

  get isOpen() { return this.socket?.readyState === WebSocket.OPEN; }

  /** Sends, or says that it could not. */
  send(message) {
    if (!this.isOpen) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  end() {
    this.ended = true;
    clearTimeout(this.timer);
    removeEventListener("online", this.again);
    // one that is not open yet is closed when it is: browsers complain of it otherwise
    if (this.socket?.readyState !== WebSocket.CONNECTING) this.socket?.close();
  }
}

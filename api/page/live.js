// The live stream: one WebSocket, opened again when it breaks; messages go to handlers by their type.

const FIRST_RETRY = 500, LONGEST_RETRY = 5000;

export class Live {
  constructor(handlers) {
    this.handlers = handlers;
    this.retry = FIRST_RETRY;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/live`);
    this.socket.onopen = () => { this.retry = FIRST_RETRY; this.handlers.connected(); };
    this.socket.onmessage = (event) => {
      const message = JSON.parse(event.data);
      this.handlers[message.type]?.(message);
    };
    this.socket.onclose = () => {
      this.handlers.disconnected(this.retry);
      setTimeout(() => this.open(), this.retry);
      this.retry = Math.min(2 * this.retry, LONGEST_RETRY);
    };
  }
}

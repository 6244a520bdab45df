// SPDX-License-Identifier: Apache-2.0
// The WebSocket to the server: says hello, hands messages on, and comes back by itself when the
// line breaks.

// handlers: {hello() -> message, open(), lost(seconds_to_retry), message(object),
// binary(ArrayBuffer), rests() -> whether the server is silent since nobody is here; optional}
export function make_connection(handlers) {
  let socket = null, retry = 0, timer = 0, heard = 0, ended = false;

  function address() {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const base = new URL('api/v1/visit', document.baseURI);
    return `${scheme}//${base.host}${base.pathname}`;
  }

  function open() {
    clearTimeout(timer);
    socket = new WebSocket(address(), 'wellspring.v1');
    socket.binaryType = 'arraybuffer';
    const mine = socket;
    mine.onopen = () => { heard = performance.now(); mine.send(JSON.stringify(handlers.hello())); };
    mine.onmessage = (event) => {
      heard = performance.now();
      if (typeof event.data === 'string') {
        let message;
        try { message = JSON.parse(event.data); } catch { return; }
        if (message.type === 'welcome') { retry = 0; handlers.open(); }
        handlers.message(message);
      } else {
        handlers.binary(event.data);
      }
    };
    mine.onclose = () => { if (socket === mine && !ended) later(); };
  }

  // Waits longer each time, with jitter, so that a restarted server is not stormed by every page at
  // once.
  function later() {
    socket = null;
    const seconds = Math.min(8, 0.4 * 2 ** retry++) * (0.75 + 0.5 * Math.random());
    handlers.lost(seconds);
    clearTimeout(timer);
    timer = setTimeout(open, seconds * 1000);
  }

  // A line that looks open but has been silent (a laptop that slept) is replaced.
  setInterval(() => {
    if (handlers.rests?.()) heard = performance.now();
    if (socket && socket.readyState === WebSocket.OPEN && !document.hidden
        && performance.now() - heard > 8000) {
      const dead = socket;
      dead.onclose = null;
      dead.close();
      later();
    }
  }, 2000);
  document.addEventListener('visibilitychange', () => {
    if (!document.hidden && !socket) { retry = 0; open(); }
    heard = performance.now();
  });
  addEventListener('pagehide', () => {
    ended = true;
    if (socket && socket.readyState === WebSocket.OPEN) socket.send('{"type":"bye"}');
  });
  addEventListener('pageshow', (event) => { if (event.persisted) { ended = false; open(); } });

  open();
  return {
    send(message) {
      if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
    },
    is_open: () => socket !== null && socket.readyState === WebSocket.OPEN,
  };
}

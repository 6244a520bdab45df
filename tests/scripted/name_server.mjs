// SPDX-License-Identifier: Apache-2.0
// A name server that has one name for several machines, as Docker and Kubernetes have (RFC 1035,
// section 4.1): whoever asks for addresses of it is told all that are there now.
import dgram from 'node:dgram';

const address_record = 1, internet = 1, seconds_to_keep = 1;

// Listens on `host`. `places`: {name: Set of addresses}. Returns {close()}.
export function start_name_server(host, places) {
  const socket = dgram.createSocket('udp4');
  socket.on('message', (question, from) => {
    const labels = [];
    let at = 12;
    for (let size; (size = question[at]) > 0; at += size + 1)
      labels.push(question.toString('latin1', at + 1, at + 1 + size));
    const type = question.readUInt16BE(at + 1), asked = question.subarray(12, at + 5);
    const known = places[labels.join('.').toLowerCase()];
    const found = known && type === address_record ? [...known] : [];
    const head = Buffer.alloc(12);
    question.copy(head, 0, 0, 2);  // the question's number
    head.writeUInt16BE(known ? 0x8580 : 0x8583, 2);  // an answer of who knows; or no such name
    head.writeUInt16BE(1, 4);
    head.writeUInt16BE(found.length, 6);
    const records = found.map((address) => {
      const record = Buffer.alloc(16);
      record.writeUInt16BE(0xc00c, 0);  // the name stands in the question
      record.writeUInt16BE(address_record, 2);
      record.writeUInt16BE(internet, 4);
      record.writeUInt32BE(seconds_to_keep, 6);
      record.writeUInt16BE(4, 10);
      Buffer.from(address.split('.').map(Number)).copy(record, 12);
      return record;
    });
    socket.send(Buffer.concat([head, asked, ...records]), from.port, from.address);
  });
  return new Promise((resolve) => socket.bind(53, host, () => resolve(socket)));
}

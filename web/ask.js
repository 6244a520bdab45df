// SPDX-License-Identifier: Apache-2.0
// Questions to the storyteller: typed, or chosen from those that the exhibit offers.
import { by_id } from './element.js';

const offered = 4;  // questions at a time

// orders: {ask(text), close()}: a question was asked; the menu is in the way of the answer
export function make_ask(orders) {
  const field = by_id('question');
  let questions = [], first = 0, speaks = false;

  function ask(text) {
    const question = text.trim();
    if (!question) return;
    field.value = '';
    first = (first + offered) % Math.max(questions.length, 1);  // others, next time
    orders.ask(question);
    offer();
    if (speaks) orders.close();
  }
  by_id('ask-form').addEventListener('submit', (event) => {
    event.preventDefault();
    ask(field.value);
  });

  function offer() {
    const some = [...questions, ...questions].slice(first, first + offered);
    by_id('questions').replaceChildren(...[...new Set(some)].map((text) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = text;
      button.addEventListener('click', () => ask(text));
      return button;
    }));
    by_id('questions').hidden = questions.length === 0;
  }

  return {
    welcome(message) {
      questions = message.questions;
      speaks = Boolean(message.storyteller);
      first = 0;
      offer();
    },
    // The answer is shown as text if there is no storyteller to speak it.
    reply(message) {
      by_id('answer').textContent = speaks ? '' : message.text;
      by_id('answer').hidden = speaks;
    },
  };
}

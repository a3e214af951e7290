// A page of a run that is not done yet: it asks for news every second, until nobody answers.

const kEvery = 1000; // [ms]
const kPatience = 3; // questions without an answer

/** @type {(update: (data: PageData) => void) => void} */
function follow(update) {
  const state = make("p", { class: "hint", id: "live" }, "This run is not done yet; the page follows it.");
  document.querySelector("h1")?.after(state);
  let silent = 0;
  const ask = async () => {
    try {
      const answer = await fetch("data", { cache: "no-store" });
      if (!answer.ok) throw new Error(`answer ${answer.status}`);
      update(await answer.json());
      silent = 0;
    } catch {
      silent += 1;
    }
    if (silent < kPatience) {
      setTimeout(ask, kEvery);
      return;
    }
    state.textContent = "The program has ended. This is its last state; the report that it has written is complete.";
    say(state.textContent);
  };
  setTimeout(ask, kEvery);
}

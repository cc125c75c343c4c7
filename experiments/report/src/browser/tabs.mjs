// The tabs of the page. Each has an address, #tab-NAME, so that a link opens it and the
// browser's back button returns to it. An address that starts with #scene opens the
// scenes, one that names a section the tab that it is in.
const tabs = [...document.querySelectorAll('[role="tab"]')];
const panel_of = (tab) => document.getElementById(tab.getAttribute('aria-controls'));

function show(chosen) {
  for (const tab of tabs) {
    tab.setAttribute('aria-selected', String(tab === chosen));
    tab.tabIndex = tab === chosen ? 0 : -1;
    panel_of(tab).hidden = tab !== chosen;
  }
}

const named = (id) => tabs.find((tab) => tab.id === id);

// The tab of an address, and the section in it that the address names.
function place_of(hash) {
  if (hash === '') return { tab: tabs[0] };
  if (hash.startsWith('#scene')) return { tab: named('tab-scenes') };
  const id = hash.slice(1);
  const section = document.getElementById(id);
  const panel = section?.closest('[role="tabpanel"]');
  return { tab: named(id) ?? tabs.find((tab) => panel_of(tab) === panel), section };
}

// Where the keys of the tab list lead from tab `i`.
const destinations = {
  ArrowRight: (i) => (i + 1) % tabs.length,
  ArrowLeft: (i) => i - 1,
  Home: () => 0,
  End: () => -1,
};

// `changed` is called with whether the scenes are shown, after every change.
export function start_tabs(changed) {
  const choose = (tab) => {
    show(tab);
    changed(tab.id === 'tab-scenes');
  };
  const follow_address = () => {
    const { tab, section } = place_of(location.hash);
    if (tab === undefined) return;
    choose(tab);
    if (section !== tab) section?.scrollIntoView();
  };
  tabs.forEach((tab, i) => {
    tab.addEventListener('click', () => {
      if (tab.getAttribute('aria-selected') === 'true') return;
      history.pushState(null, '', `#${tab.id}`);
      choose(tab);
    });
    // Keys pass tabs on their way: they leave no trace in the history.
    tab.addEventListener('keydown', (event) => {
      if (!Object.hasOwn(destinations, event.key)) return;
      const next = tabs.at(destinations[event.key](i));
      event.preventDefault();
      history.replaceState(null, '', `#${next.id}`);
      choose(next);
      next.focus();
    });
  });
  addEventListener('hashchange', follow_address);
  follow_address();
}

// The tabs of the page. An address that starts with #scene opens the scenes, one that
// names a section the tab that it is in.
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

// `changed` is called with whether the scenes are shown, after every change.
export function start_tabs(changed) {
  const choose = (tab) => {
    show(tab);
    changed(tab.id === 'tab-scenes');
  };
  const follow_address = () => {
    if (location.hash.startsWith('#scene')) choose(named('tab-scenes'));
    else if (location.hash !== '') {
      const target = document.getElementById(location.hash.slice(1));
      const panel = target?.closest('[role="tabpanel"]');
      if (!panel) return;
      choose(tabs.find((tab) => panel_of(tab) === panel));
      target.scrollIntoView();
    }
  };
  tabs.forEach((tab, i) => {
    tab.addEventListener('click', () => choose(tab));
    tab.addEventListener('keydown', ({ key }) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[key];
      if (step === undefined) return;
      const next = tabs.at((i + step) % tabs.length);
      choose(next);
      next.focus();
    });
  });
  addEventListener('hashchange', follow_address);
  follow_address();
}

// Foxglove Studio (npm: @foxglove/studio-base, MPL-2.0) with our layout and drawings, offline.
'use strict';

// No setting outlives a reload, and nothing is reported to anyone.
function settings() {
  const values = new Map(Object.entries({
    colorScheme: 'dark', 'ui.open-dialog-startup': false, hideSignInPrompt: true,
    'updates.enabled': false, 'telemetry.telemetryEnabled': false,
    'telemetry.crashReportingEnabled': false}));
  const listeners = new Map();
  const of = key => listeners.get(key) || listeners.set(key, new Set()).get(key);
  return {
    get: key => values.get(key),
    set: async (key, value) => { values.set(key, value); of(key).forEach(told => told(value)); },
    addChangeListener: (key, told) => of(key).add(told),
    removeChangeListener: (key, told) => of(key).delete(told),
  };
}

// The stages' own messages are drawn (goshawk_messages.js), so markers are hidden. Plots show all of a
// recording, and the last seconds of a live flight.
function fitted(layout, {recording, places}) {
  const topics = layout.configById['3D!goshawk'].topics;
  for (const name of Object.keys(topics)) if (name.startsWith('/view/')) topics[name].visible = false;
  for (const panel of Object.values(layout.configById)) if (recording) delete panel.followingViewWidth;
  if (places.length) Object.assign(layout.configById['3D!goshawk'].cameraState, cameraOn(places));
  return layout;
}

// Looks at the places from above, across their long side.
function cameraOn(places) {
  const axes = [0, 1, 2].map(i => places.map(p => p[i]));
  const lower = axes.map(a => Math.min(...a)), upper = axes.map(a => Math.max(...a));
  const turned = 15 - Goshawk.longSide(places).angle * 180 / Math.PI;
  return {targetOffset: V3.mix(lower, upper, 0.5), distance: 4 + 0.95 * V3.norm(V3.add(upper, lower, -1)),
          phi: 35, thetaOffset: (turned + 360) % 360};
}

function layouts(data) {
  const savedAt = new Date().toISOString();
  const all = new Map([['goshawk', {id: 'goshawk', name: 'Goshawk', permission: 'CREATOR_WRITE',
                                    baseline: {data, savedAt}}]]);
  return {
    list: async () => [...all.values()],
    get: async (space, id) => all.get(id),
    put: async (space, layout) => { all.set(layout.id, layout); return layout; },
    delete: async (space, id) => { all.delete(id); },
    importLayouts: async () => {},
  };
}

function extensions(source) {
  const ours = {id: 'goshawk', name: 'goshawk', displayName: 'Goshawk', publisher: 'goshawk',
                qualifiedName: 'goshawk', namespace: 'local', version: '1', license: 'Apache-2.0',
                description: 'Draws maps, plans and flights', homepage: '', keywords: []};
  const no = async () => { throw new Error('extensions come and go with goshawk view'); };
  return [{namespace: 'local', getExtensions: async () => [ours], loadExtension: async () => source,
           installExtension: no, uninstallExtension: no}];
}

// The studio takes its data source from the address.
function show({bridge, recording}) {
  const address = new URL(location.href);
  const wanted = {layoutId: 'goshawk', ds: bridge ? 'foxglove-websocket' : 'remote-file',
                  'ds.url': bridge || new URL(recording, address).href};
  for (const [name, value] of Object.entries(wanted)) {
    if (!address.searchParams.has(name)) address.searchParams.set(name, value);
  }
  history.replaceState(null, '', address);
  // No side bar and no hints at first.
  const first = {
    'fox.workspace': {state: {sidebarItem: null, leftSidebarOpen: false}, version: 0},
    'studio.profile-data': {onboarding: {settingsTooltipShownForPanelTypes: ['3D']}}};
  for (const [name, value] of Object.entries(first)) {
    if (!localStorage.getItem(name)) localStorage.setItem(name, JSON.stringify(value));
  }
}

async function main() {
  const said = async name => {
    const answer = await fetch(name);
    if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
    return answer;
  };
  const source = await (await said('show.json')).json();
  const layout = fitted(await (await said('layout.json')).json(), source);
  const drawing = `const kPlaces = ${JSON.stringify(source.places)};\n` +
      await (await said('goshawk_messages.js')).text();
  show(source);
  await window.initI18n();
  const app = React.createElement(window.App, {
    deepLinks: [location.href], appConfiguration: settings(), layoutStorage: layouts(layout),
    dataSources: [new window.FoxgloveWebSocketDataSourceFactory(),
                  new window.RemoteDataSourceFactory(), new window.McapLocalDataSourceFactory()],
    extensionLoaders: extensions(drawing), enableGlobalCss: true});
  document.getElementById('wait').remove();
  ReactDOM.render(app, document.getElementById('root'));
}

main().catch(error => {
  document.getElementById('wait').textContent = 'Foxglove Studio does not start: ' + error.message;
  console.error(error);
});

// Which page this is: one of a flight, or a live one.
'use strict';
window.addEventListener('DOMContentLoaded', () => {
  const data = JSON.parse(document.getElementById('flight').textContent);
  window.goshawk = data.live ? new Goshawk.LivePage(data) : new Goshawk.FlightPage(data);
  window.goshawk.run();
});

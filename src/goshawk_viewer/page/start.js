// Starts the page of a flight or the live page.
'use strict';
window.addEventListener('DOMContentLoaded', () => {
  const data = JSON.parse(document.getElementById('flight').textContent);
  setTimeout(() => {  // the page says first that it draws
    window.goshawk = data.live ? new Goshawk.LivePage(data) : new Goshawk.FlightPage(data);
    window.goshawk.run();
  }, 30);
});

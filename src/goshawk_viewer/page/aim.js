// Goals that are given in the live page: a click at a height, or three numbers.
'use strict';

Object.assign(Goshawk.LivePage.prototype, {
  showHeight() {
    $('goal-text').textContent = Number($('goal-height').value).toFixed(1) + ' m';
  },

  aim(on) {
    if (on && this.measuring) this.measure(false);
    this.aiming = on;
    $('goal').setAttribute('aria-pressed', on);
    document.body.classList.toggle('aiming', on);
    if (!on && this.view) this.view.setAim(null);
  },

  // Where the pointer is at the chosen height; the picture and the panel show it.
  aimAt(event) {
    const goal = this.view.pick(event, Number($('goal-height').value));
    this.view.setAim(goal);
    this.state.text = goal ? `goal: ${this.place(goal)}` : 'no goal there: the pointer is above the horizon';
    this.tell();
    return goal;
  },

  place(p) { return p.map(c => c.toFixed(2)).join(', '); },

  send(goal) {
    this.aim(false);
    const linked = this.state.link === 'connected';
    if (linked) this.client.sendGoal(goal);
    this.sent = linked ? goal : null;
    this.state.text = linked ? `goal sent: ${this.place(goal)}` : 'not sent: no connection';
    this.tell();
  },

  bindGoal() {
    const canvas = $('view');
    let down = null;
    $('goal-height').addEventListener('input', () => this.showHeight());
    this.showHeight();
    $('goal').addEventListener('click', () => this.aim(!this.aiming && Boolean(this.view)));
    window.addEventListener('keydown', event => { if (event.key === 'Escape') this.aim(false); });
    canvas.addEventListener('pointerdown', event => { down = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointermove', event => { if (this.aiming && !event.buttons) this.aimAt(event); });
    canvas.addEventListener('pointerup', event => {
      const moved = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]);
      if (!this.aiming || moved === null || moved > 4) return;
      const goal = this.aimAt(event);
      if (goal) this.send(goal);
    });
    $('goal-place').addEventListener('keydown', event => {
      if (event.key !== 'Enter') return;
      const goal = event.target.value.split(/[\s,;]+/).filter(Boolean).map(Number);
      if (goal.length === 3 && goal.every(Number.isFinite)) return this.send(goal);
      this.state.text = 'a goal is three numbers, such as 3, 8, 2';
      this.tell();
    });
  }
});

// A client of the Foxglove WebSocket protocol, version 1.
'use strict';
Goshawk.FoxgloveClient = class {
  // topics: {"odom": ["nav_msgs/msg/Odometry", message => ...]} by the end of the topic's name and its type;
  // onState(text): of the connection
  constructor(url, topics, onState) {
    Object.assign(this, {url, topics, onState});
    this.connect();
  }

  connect() {
    this.channels = new Map();
    this.unread = this.unread || new Set();  // topics that are not subscribed to for now
    this.subscriptions = new Map();
    this.socket = new WebSocket(this.url, ['foxglove.websocket.v1']);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => {
      this.onState('connected');
      this.say({op: 'advertise', channels: [
        {id: 1, topic: 'goal_pose', encoding: 'json', schemaName: 'geometry_msgs/msg/PoseStamped'},
        {id: 2, topic: 'operator_command', encoding: 'json', schemaName: 'goshawk_msgs/msg/OperatorCommand'}]});
    };
    this.socket.onmessage = event => {
      if (typeof event.data === 'string') this.onText(JSON.parse(event.data));
      else this.onBinary(new DataView(event.data));
    };
    this.socket.onclose = event => {
      this.onState('no connection to ' + this.url + (event.reason ? ': ' + event.reason : '') + '; trying again');
      setTimeout(() => this.connect(), 1000);
    };
  }

  say(message) { this.socket.send(JSON.stringify(message)); }

  onText(message) {
    if (message.op === 'status') this.onState(message.message);
    if (message.op !== 'advertise') return;
    for (const channel of message.channels) {
      const name = Object.keys(this.topics).find(
          t => (channel.topic === t || channel.topic.endsWith('/' + t)) && channel.schemaName === this.topics[t][0]);
      if (!name || [...this.channels.values()].includes(name)) continue;
      this.channels.set(channel.id, name);
      this.subscriptions.set(channel.id, {take: this.topics[name][1], schema: new Goshawk.Schema(channel.schema)});
      if (!this.unread.has(name)) this.ask('subscribe', channel.id);
    }
  }

  ask(op, id) {
    if (op === 'subscribe') this.say({op, subscriptions: [{id, channelId: id}]});
    else this.say({op, subscriptionIds: [id]});
  }

  // Reads a topic from now on, or no longer.
  read(name, on) {
    if (on !== this.unread.has(name)) return;
    if (on) this.unread.delete(name);
    else this.unread.add(name);
    for (const [id, of] of this.channels) if (of === name) this.ask(on ? 'subscribe' : 'unsubscribe', id);
  }

  onBinary(view) {
    if (view.getUint8(0) !== 1) return;
    const subscription = this.subscriptions.get(view.getUint32(1, true));
    if (!subscription) return;
    try {
      subscription.take(subscription.schema.read(new DataView(view.buffer, 13)));
    } catch (error) {
      console.warn('a message cannot be read: ' + error);
    }
  }

  sendGoal(p) {
    this.publish(1, {header: {frame_id: 'map'},
                     pose: {position: {x: p[0], y: p[1], z: p[2]}, orientation: {w: 1}}});
  }

  // verb: a constant of OperatorCommand; a command that is sent again has the same id
  sendCommand(id, verb) { this.publish(2, {id, client: 'page', verb}); }

  publish(channel, message) {
    const body = new TextEncoder().encode(JSON.stringify(message));
    const frame = new Uint8Array(5 + body.length);
    frame[0] = 1;
    new DataView(frame.buffer).setUint32(1, channel, true);
    frame.set(body, 5);
    this.socket.send(frame);
  }
};

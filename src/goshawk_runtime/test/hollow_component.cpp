// Named like a component, but registers none.
extern "C" int hollow() {
  return 0;
}

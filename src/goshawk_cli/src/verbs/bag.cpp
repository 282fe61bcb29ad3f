#include "verbs/verbs.hpp"

namespace goshawk::cli {

void add_bag(Program& program) {
  const Verb bag = program.verb("bag", "record and replay, by their names in ROS 2");
  describe_record(bag.word("record", "the same as goshawk record"));
  describe_replay(bag.word("play", "the same as goshawk replay"));
  describe_recording_info(bag.word("info", "the same as goshawk replay --list"));
}

}  // namespace goshawk::cli

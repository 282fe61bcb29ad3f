#include "goshawk/introspection/topic_command.hpp"

#include "topic_verbs.hpp"

namespace goshawk::introspection {

int topic_command(std::vector<std::string> arguments) {
  static const std::vector<Verb> kVerbs = {topic_list_verb(), topic_info_verb(),  topic_echo_verb(),
                                           topic_hz_verb(),   topic_delay_verb(), topic_bw_verb(),
                                           topic_pub_verb()};
  return run_verb("topic", kVerbs, std::move(arguments));
}

}  // namespace goshawk::introspection

#pragma once

#include "session.hpp"

namespace goshawk::introspection {

Verb topic_list_verb();
Verb topic_info_verb();
Verb topic_echo_verb();
Verb topic_hz_verb();
Verb topic_delay_verb();
Verb topic_bw_verb();
Verb topic_pub_verb();

}  // namespace goshawk::introspection

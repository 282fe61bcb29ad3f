#pragma once

#include "verbs/verbs.hpp"

/// The words below `goshawk topic`.
namespace goshawk::cli {

void add_topic_list(const Verb& topic);
void add_topic_info(const Verb& topic);
void add_topic_type(const Verb& topic);
void add_topic_find(const Verb& topic);
void add_topic_echo(const Verb& topic);
void add_topic_meters(const Verb& topic);  // hz, delay, bw
void add_topic_pub(const Verb& topic);

}  // namespace goshawk::cli

// What a C program with Eclipse Cyclone DDS needs to speak to Goshawk, beside the types that
// idlc makes from idl/.
#ifndef GOSHAWK_DDS_H
#define GOSHAWK_DDS_H

#include <dds/dds.h>
#include <stdbool.h>

// A topic as ROS 2 names it: "rt/" before the name, "dds_::" and "_" around the type. idlc writes
// the plain type name into the descriptor, so a copy of it gets the other one.
dds_entity_t goshawk_topic(dds_entity_t participant, const dds_topic_descriptor_t* type,
                           const char* wire_type, const char* name);

// Reliable, last `depth`; latched: also for late joiners.
dds_entity_t goshawk_writer(dds_entity_t participant, dds_entity_t topic, int depth, bool latched);
dds_entity_t goshawk_reader(dds_entity_t participant, dds_entity_t topic, int depth, bool latched);

// The next valid sample, waiting for it up to timeout_s; NULL where none came. Give it back with
// dds_return_loan(reader, &sample, 1).
void* goshawk_take(dds_entity_t reader, double timeout_s);

#endif

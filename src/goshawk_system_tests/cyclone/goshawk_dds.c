#include "goshawk_dds.h"

#include <stdio.h>
#include <stdlib.h>

static void require(dds_entity_t entity, const char* what) {
  if (entity >= 0) return;
  fprintf(stderr, "%s: %s\n", what, dds_strretcode(-entity));
  exit(2);
}

dds_entity_t goshawk_topic(dds_entity_t participant, const dds_topic_descriptor_t* type,
                           const char* wire_type, const char* name) {
  dds_topic_descriptor_t descriptor = *type;
  descriptor.m_typename = wire_type;
  const dds_entity_t topic = dds_create_topic(participant, &descriptor, name, NULL, NULL);
  require(topic, name);
  return topic;
}

static dds_qos_t* make_qos(int depth, bool latched) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, depth);
  // A writer says in XCDR1 what Fast DDS 2 and ROS 2 read.
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &xcdr1);
  return qos;
}

dds_entity_t goshawk_writer(dds_entity_t participant, dds_entity_t topic, int depth, bool latched) {
  dds_qos_t* qos = make_qos(depth, latched);
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  require(writer, "writer");
  return writer;
}

dds_entity_t goshawk_reader(dds_entity_t participant, dds_entity_t topic, int depth, bool latched) {
  dds_qos_t* qos = make_qos(depth, latched);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, NULL);
  dds_delete_qos(qos);
  require(reader, "reader");
  return reader;
}

void* goshawk_take(dds_entity_t reader, double timeout_s) {
  const dds_time_t end = dds_time() + (dds_duration_t)(timeout_s * 1e9);
  for (;;) {
    void* sample = NULL;
    dds_sample_info_t info;
    if (dds_take(reader, &sample, &info, 1, 1) == 1) {
      if (info.valid_data) return sample;
      dds_return_loan(reader, &sample, 1);
      continue;
    }
    if (dds_time() > end) return NULL;
    dds_sleepfor(DDS_MSECS(1));
  }
}

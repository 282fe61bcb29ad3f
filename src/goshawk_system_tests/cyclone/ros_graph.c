// ros_graph NODE TOPIC: waits until ros_discovery_info tells that NODE writes TOPIC and every
// endpoint in that message was discovered, then prints the node's topics as JSON. It knows of
// rmw_dds_common.idl, and of nothing else of Goshawk.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "goshawk_dds.h"
#include "rmw_dds_common.h"

typedef rmw_dds_common_msg_Gid Gid;
typedef rmw_dds_common_msg_NodeEntitiesInfo Node;
typedef rmw_dds_common_msg_ParticipantEntitiesInfo Entities;

enum { MOST_ENDPOINTS = 4096, LONGEST_TOPIC = 256 };

typedef struct {
  dds_guid_t key;
  char topic[LONGEST_TOPIC];
} Endpoint;

static Endpoint endpoints[MOST_ENDPOINTS];
static int endpoint_count = 0;

// Adds what a built-in topic has told.
static void discover(dds_entity_t reader) {
  void* samples[64] = {NULL};
  dds_sample_info_t info[64];
  const int count = dds_take(reader, samples, info, 64, 64);
  for (int i = 0; i < count && endpoint_count < MOST_ENDPOINTS; ++i) {
    if (!info[i].valid_data) continue;
    const dds_builtintopic_endpoint_t* found = samples[i];
    Endpoint* e = &endpoints[endpoint_count++];
    e->key = found->key;
    snprintf(e->topic, sizeof e->topic, "%s", found->topic_name);
  }
  if (count > 0) dds_return_loan(reader, samples, count);
}

// NULL where that endpoint is not known, or the gid does not end with zeros.
static const char* topic_of(const Gid* gid) {
  static const uint8_t zeros[8] = {0};
  if (memcmp(gid->data + 16, zeros, sizeof zeros) != 0) return NULL;
  for (int i = 0; i < endpoint_count; ++i) {
    if (memcmp(endpoints[i].key.v, gid->data, 16) == 0) return endpoints[i].topic;
  }
  return NULL;
}

static bool is_node(const Node* node, const char* full_name) {
  char name[600];
  snprintf(name, sizeof name, "%s/%s", strcmp(node->node_namespace, "/") == 0 ? "" : node->node_namespace,
           node->node_name);
  return strcmp(name, full_name) == 0;
}

static bool is_whole(const Node* node, const char* topic) {
  bool writes = false;
  for (uint32_t i = 0; i < node->writer_gid_seq._length; ++i) {
    const char* name = topic_of(&node->writer_gid_seq._buffer[i]);
    if (name == NULL) return false;
    writes = writes || strcmp(name, topic) == 0;
  }
  for (uint32_t i = 0; i < node->reader_gid_seq._length; ++i) {
    if (topic_of(&node->reader_gid_seq._buffer[i]) == NULL) return false;
  }
  return writes;
}

static void print_topics(const char* what, const Gid* gids, uint32_t count) {
  printf("\"%s\": [", what);
  for (uint32_t i = 0; i < count; ++i) {
    printf("%s\"%s\"", i == 0 ? "" : ", ", topic_of(&gids[i]));
  }
  printf("]");
}

static bool print_if_whole(const Entities* told, const char* name, const char* topic) {
  for (uint32_t i = 0; i < told->node_entities_info_seq._length; ++i) {
    const Node* node = &told->node_entities_info_seq._buffer[i];
    if (!is_node(node, name) || !is_whole(node, topic)) continue;
    printf("{\"participant_entity\": \"%02x%02x%02x%02x\", ", told->gid.data[12],
           told->gid.data[13], told->gid.data[14], told->gid.data[15]);
    print_topics("writes", node->writer_gid_seq._buffer, node->writer_gid_seq._length);
    printf(", ");
    print_topics("reads", node->reader_gid_seq._buffer, node->reader_gid_seq._length);
    printf("}\n");
    return true;
  }
  return false;
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: ros_graph NODE TOPIC, as in /navigator rt/plan_request\n");
    return 2;
  }
  const char* domain = getenv("ROS_DOMAIN_ID");
  const dds_entity_t dp =
      dds_create_participant(domain ? (dds_domainid_t)atoi(domain) : 0, NULL, NULL);
  const dds_entity_t writers = dds_create_reader(dp, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, NULL, NULL);
  const dds_entity_t readers =
      dds_create_reader(dp, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, NULL, NULL);
  const dds_entity_t graph = goshawk_reader(
      dp,
      goshawk_topic(dp, &rmw_dds_common_msg_ParticipantEntitiesInfo_desc,
                    "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", "ros_discovery_info"),
      1000, true);
  // A message may come before the endpoints of which it tells: each is kept until they are known.
  void* kept[1000] = {NULL};
  int kept_count = 0;
  for (int i = 0; i < 2000; ++i) {
    discover(writers);
    discover(readers);
    void* sample = goshawk_take(graph, 0.02);
    if (sample != NULL && kept_count < 1000) kept[kept_count++] = sample;
    for (int k = kept_count; k > 0; --k) {  // the newest first
      if (print_if_whole(kept[k - 1], argv[1], argv[2])) return 0;
    }
  }
  fprintf(stderr, "%d messages on ros_discovery_info, none of %s writing %s with known endpoints\n",
          kept_count, argv[1], argv[2]);
  return 1;
}

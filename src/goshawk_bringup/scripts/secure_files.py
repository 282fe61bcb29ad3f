"""The XML documents of DDS Security, as Fast DDS reads them."""

from xml.sax.saxutils import escape, quoteattr

import topic_rights

PROTECTED = ("discovery", "liveliness", "rtps")


def subject_of(name):
    """In the order of RFC 2253: any other, and Fast DDS only says that it cannot join."""
    return f"CN={name},O=Goshawk"


def governance():
    """Nobody without a certificate, everything encrypted, every topic under access control."""
    kinds = "".join(f"<{k}_protection_kind>ENCRYPT</{k}_protection_kind>" for k in PROTECTED)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-Security/20170801/omg_shared_ca_governance.xsd">
  <domain_access_rules><domain_rule>
    <domains><id_range><min>0</min><max>232</max></id_range></domains>
    <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
    <enable_join_access_control>true</enable_join_access_control>
    {kinds}
    <topic_access_rules><topic_rule>
      <topic_expression>*</topic_expression>
      <enable_discovery_protection>true</enable_discovery_protection>
      <enable_liveliness_protection>true</enable_liveliness_protection>
      <enable_read_access_control>true</enable_read_access_control>
      <enable_write_access_control>true</enable_write_access_control>
      <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
      <data_protection_kind>ENCRYPT</data_protection_kind>
    </topic_rule></topic_access_rules>
  </domain_rule></domain_access_rules>
</dds>
"""


def authority_configuration(folder):
    """For `openssl ca`, with its database in a folder of its own."""
    return f"""[ca]
default_ca = own
[own]
database = {folder}/database
new_certs_dir = {folder}
default_md = sha256
unique_subject = no
rand_serial = yes
policy = names
[names]
organizationName = supplied
commonName = supplied
[authority]
subjectKeyIdentifier = hash
authorityKeyIdentifier = keyid:always
basicConstraints = critical, CA:true
"""


def topics(tag, names, namespace):
    if not names:
        return ""
    inner = "".join(f"<topic>{escape(topic_rights.wire_name(n, namespace))}</topic>" for n in names)
    return f"<{tag}><topics>{inner}</topics></{tag}>"


def permissions(name, reads, writes, namespace, begin, end):
    """@param begin, end of their validity, as in 2026-01-31T00:00:00"""
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-Security/20170801/omg_shared_ca_permissions.xsd">
  <permissions><grant name={quoteattr(name)}>
    <subject_name>{escape(subject_of(name))}</subject_name>
    <validity><not_before>{begin}</not_before><not_after>{end}</not_after></validity>
    <allow_rule>
      <domains><id_range><min>0</min><max>232</max></id_range></domains>
      {topics("publish", writes, namespace)}
      {topics("subscribe", reads, namespace)}
    </allow_rule>
    <default>DENY</default>
  </grant></permissions>
</dds>
"""


def profile(folder, authority):
    """A participant on loopback with the certificate in `folder`."""
    prefix = "dds.sec.auth.builtin.PKI-DH."
    access = "dds.sec.access.builtin.Access-Permissions."
    values = {
        "dds.sec.auth.plugin": "builtin.PKI-DH",
        prefix + "identity_ca": f"file://{authority}/ca.pem",
        prefix + "identity_certificate": f"file://{folder}/certificate.pem",
        prefix + "private_key": f"file://{folder}/key.pem",
        "dds.sec.access.plugin": "builtin.Access-Permissions",
        access + "permissions_ca": f"file://{authority}/ca.pem",
        access + "governance": f"file://{authority}/governance.smime",
        access + "permissions": f"file://{folder}/permissions.smime",
        "dds.sec.crypto.plugin": "builtin.AES-GCM-GMAC",
    }
    properties = "\n          ".join(
        f"<property><name>{n}</name><value>{escape(v)}</value></property>" for n, v in values.items())
    locator = "<locator><udpv4><address>127.0.0.1</address></udpv4></locator>"
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<dds><profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors><transport_descriptor>
    <transport_id>loopback</transport_id><type>UDPv4</type>
    <sendBufferSize>4194304</sendBufferSize><receiveBufferSize>4194304</receiveBufferSize>
    <maxInitialPeersRange>60</maxInitialPeersRange>
    <interfaceWhiteList><address>127.0.0.1</address></interfaceWhiteList>
  </transport_descriptor></transport_descriptors>
  <participant profile_name="secured" is_default_profile="true">
    <rtps>
      <builtin>
        <metatrafficUnicastLocatorList>{locator}</metatrafficUnicastLocatorList>
        <initialPeersList>{locator}</initialPeersList>
      </builtin>
      <userTransports><transport_id>loopback</transport_id></userTransports>
      <useBuiltinTransports>false</useBuiltinTransports>
      <propertiesPolicy>
        <properties>
          {properties}
        </properties>
      </propertiesPolicy>
    </rtps>
  </participant>
</profiles></dds>
"""

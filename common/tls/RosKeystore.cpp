#include "common/tls/RosKeystore.h"

#include "common/files/SavedFile.h"
#include "common/tls/Certificates.h"
#include "common/tls/KeyFolder.h"

#include <QDateTime>
#include <QDir>

namespace hermes {
namespace {

const QString authorityCertificate("public/ca.cert.pem"), authorityKey("private/ca.key.pem");

/// Nobody joins without keys, and all is encrypted. Source: OMG DDS Security 1.1, 9.4.1.2.
QByteArray governance() {
    return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>230</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>SIGN</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>ENCRYPT</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)";
}

/// Source: the same, 9.4.1.3.
QByteArray permissions(const QString &name, bool canCommand, int days) {
    const QDateTime now = QDateTime::currentDateTimeUtc();
    const auto day = [](const QDateTime &time) { return time.toString("yyyy-MM-ddTHH:mm:ss"); };
    QString published;
    const QStringList own{"ros_discovery_info", "rt/rosout", "rt/parameter_events", "rr/*"};
    for (const QString &topic : canCommand ? QStringList("*") : own)
        published += "<topic>" + topic + "</topic>";
    return QString(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="/%1">
      <subject_name>CN=%1</subject_name>
      <validity><not_before>%2</not_before><not_after>%3</not_after></validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>230</max></id_range></domains>
        <publish><topics>%4</topics></publish>
        <subscribe><topics><topic>*</topic></topics></subscribe>
      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)")
        .arg(name, day(now.addDays(-1)), day(now.addDays(days)), published)
        .toUtf8();
}

} // namespace

Result<QString> RosKeystore::addEnclave(const QString &name, bool canCommand, int days) const {
    if (const Result<void> named = checkCertificateName(name); !named)
        return named.error();
    const QString enclave = "enclaves/" + name + '/';
    if (QFileInfo::exists(folder_ + '/' + enclave))
        return Error(ErrorCode::InputOutput, folder_ + '/' + enclave + ": it exists, expected a new name");
    if (!QFileInfo::exists(folder_ + '/' + authorityCertificate))
        if (const Result<void> made = make(days); !made)
            return made.error();
    const Result<QByteArray> certificate = load(authorityCertificate), key = load(authorityKey),
                             rules = load("enclaves/governance.p7s");
    for (const Result<QByteArray> &one : {certificate, key, rules})
        if (!one)
            return one.error();
    const CertifiedKey authority{*certificate, *key};
    const Result<CertifiedKey> own = issueCertificate(authority, {name, QString()}, days);
    if (!own)
        return own.error();
    const QByteArray allowed = permissions(name, canCommand, days);
    const Result<QByteArray> signedOnes = signText(authority, allowed);
    if (!signedOnes)
        return signedOnes.error();
    for (const Result<void> &saved :
         {save(enclave + "identity_ca.cert.pem", *certificate),
          save(enclave + "permissions_ca.cert.pem", *certificate), save(enclave + "governance.p7s", *rules),
          save(enclave + "permissions.xml", allowed), save(enclave + "permissions.p7s", *signedOnes),
          save(enclave + "cert.pem", own->certificate), save(enclave + "key.pem", own->key, true)})
        if (!saved)
            return saved.error();
    return folder_ + '/' + enclave.chopped(1);
}

Result<void> RosKeystore::make(int days) const {
    const Result<CertifiedKey> authority = makeAuthority("ros2", days);
    if (!authority)
        return authority.error();
    const Result<QByteArray> rules = signText(*authority, governance());
    if (!rules)
        return rules.error();
    for (const QString &kind : {QString("identity_"), QString("permissions_"), QString()})
        for (const Result<void> &saved : {save("public/" + kind + "ca.cert.pem", authority->certificate),
                                          save("private/" + kind + "ca.key.pem", authority->key, true)})
            if (!saved)
                return saved;
    const Result<void> saved = save("enclaves/governance.xml", governance());
    return saved ? save("enclaves/governance.p7s", *rules) : saved;
}

Result<void> RosKeystore::save(const QString &file, const QByteArray &bytes, bool isSecret) const {
    const QString path = folder_ + '/' + file;
    if (!QDir().mkpath(QFileInfo(path).path()))
        return Error(ErrorCode::InputOutput, QFileInfo(path).path() + ": cannot be made");
    return isSecret ? writeKeyFile(path, bytes) : saveFile(path, bytes);
}

Result<QByteArray> RosKeystore::load(const QString &file) const {
    QFile opened(folder_ + '/' + file);
    if (!opened.open(QIODevice::ReadOnly))
        return Error(ErrorCode::InputOutput, opened.fileName() + ": " + opened.errorString());
    return opened.read(1 << 20);
}

} // namespace hermes

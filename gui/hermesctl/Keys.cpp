#include "common/Role.h"
#include "common/tls/Authority.h"
#include "common/tls/KeyFolder.h"
#include "common/tls/RosKeystore.h"
#include "gui/hermesctl/Commands.h"

#include <QDir>
#include <QHostInfo>
#include <QJsonArray>

namespace hermes::ctl {
namespace {

constexpr int daysOfAuthority = 20 * 365;

QString stateOf(const Authority::Issued &one) {
    return one.isRevoked ? "revoked" : one.until < QDateTime::currentDateTimeUtc() ? "expired" : "valid";
}

} // namespace

Result<void> checkKeyRole(const Arguments &arguments) {
    if (roleFrom(arguments.role) || arguments.role == PeerCertificate::daemonRole())
        return {};
    const QString found = arguments.role.isEmpty() ? "missing" : QString("\"%1\"").arg(arguments.role);
    return Error(ErrorCode::InvalidParams,
                 QString("option --role is %1, expected one of %2 (for people), daemon (for robots)")
                     .arg(found, roleNames().join(", ")));
}

Result<void> keysInit(const Arguments &arguments) {
    const QString owner =
        QString("%1@%2").arg(qEnvironmentVariable("USER", "user"), QHostInfo::localHostName());
    const auto done = Authority(KeyFolder::usual()).init(owner, daysOfAuthority, Arguments().days);
    if (!done)
        return done;
    print(arguments, QJsonObject{{"folder", KeyFolder::usual()}, {"name", owner}},
          QString("%1: the authority, and the keys of %2, an engineer.\n"
                  "Keep authority.key secret: who has it can make keys for all robots of this "
                  "authority.\nNext, for a robot:  hermesctl keys pair NAME --role daemon, or keys issue")
              .arg(KeyFolder::usual(), owner));
    return {};
}

Result<void> keysIssue(const Arguments &arguments) {
    const QString name = arguments.words.first();
    const auto folder = Authority(KeyFolder::usual()).issue({name, arguments.role}, arguments.days);
    if (!folder)
        return folder.error();
    print(arguments, QJsonObject{{"folder", *folder}, {"name", name}, {"role", arguments.role}},
          QString("%1: the keys of %2. Copy the folder, by a way that nobody else can read, to where "
                  "its programs look for keys (usually ~/.config/hermes/keys), and delete it here. "
                  "For a robot, or the computer of a person:\n  ssh %2 mkdir -p -m 700 "
                  ".config/hermes/keys\n  scp -p %1/* %2:.config/hermes/keys/")
              .arg(*folder, name));
    return {};
}

Result<void> keysRos(const Arguments &arguments) {
    const QString store = arguments.words.value(0), name = arguments.words.value(1);
    const Result<QString> enclave =
        RosKeystore(store).addEnclave(name, arguments.role != toString(Role::Observer), arguments.days);
    if (!enclave)
        return enclave.error();
    print(
        arguments, QJsonObject{{"folder", *enclave}, {"name", name}, {"role", arguments.role}},
        arguments.role == PeerCertificate::daemonRole()
            ? QString("%1: the keys of the robot %2. Copy the folder there, by a way that nobody else can "
                      "read, and set "
                      "it:\n  hermesctl set ros2 enclave=%1")
                  .arg(*enclave, name)
            : QString(
                  "%1: the keys of %2. On the laptop, with the keystore but its folder private:\n"
                  "  export ROS_SECURITY_KEYSTORE=%3 ROS_SECURITY_ENABLE=true ROS_SECURITY_STRATEGY=Enforce\n"
                  "  ros2 run ... --ros-args --enclave /%2")
                  .arg(*enclave, name, QDir(store).absolutePath()));
    return {};
}

Result<void> keysRevoke(const Arguments &arguments) {
    const auto count = Authority(KeyFolder::usual()).revoke(arguments.words.first());
    if (!count)
        return count.error();
    const QString file = KeyFolder::usual() + '/' + KeyFolder::revokedFile();
    print(arguments, QJsonObject{{"revoked", *count}, {"file", file}},
          QString("%1 revoked. Copy %2 into the folder of keys of each robot: it has effect within a "
                  "second, also on those who are connected.")
              .arg(*count)
              .arg(file));
    return {};
}

Result<void> keysList(const Arguments &arguments) {
    const auto all = Authority(KeyFolder::usual()).list();
    if (!all)
        return all.error();
    QJsonArray json;
    std::vector<QStringList> rows{{"name", "role", "serial number", "valid until", "state"}};
    for (const Authority::Issued &one : *all) {
        const QString until = one.until.toString(Qt::ISODate);
        rows.push_back({one.subject.name, one.subject.role, one.serial, until, stateOf(one)});
        json.append(QJsonObject{{"name", one.subject.name},
                                {"role", one.subject.role},
                                {"serial", one.serial},
                                {"until", until},
                                {"state", stateOf(one)}});
    }
    arguments.json ? printJson(json) : printTable(rows);
    return {};
}

} // namespace hermes::ctl

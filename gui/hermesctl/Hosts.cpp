#include "gui/hermesctl/Hosts.h"

#include "common/files/SavedFile.h"
#include "common/interface/InterfaceUrl.h"
#include "common/tls/Authority.h"
#include "common/tls/KeyFolder.h"
#include "gui/hermesctl/NetworkBrowser.h"

#include <QDir>
#include <QFileInfo>
#include <QHostAddress>
#include <QStandardPaths>

namespace hermes::ctl {
namespace {

constexpr int maxHosts = 20;
constexpr qint64 maxBytes = 10000;

QString fileName() {
    return QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation) + "/hermes/hosts";
}

QStringList reached() {
    QFile file(fileName());
    if (!file.open(QIODevice::ReadOnly))
        return {};
    return QString::fromUtf8(file.read(maxBytes)).split('\n', Qt::SkipEmptyParts).mid(0, maxHosts);
}

/// Empty: one of this computer, or none.
QString hostOf(const QString &address) {
    const auto url = InterfaceUrl::parse(address);
    const bool isFar = url && (url->scheme == "tcp" || url->scheme == "tls") && url->host != "localhost" &&
                       !QHostAddress(url->host).isLoopback();
    return isFar ? url->host : QString();
}

} // namespace

void rememberHost(const QString &address) {
    const QString host = hostOf(address);
    QStringList hosts = reached();
    if (host.isEmpty() || hosts.value(0) == host)
        return;
    hosts.removeAll(host);
    hosts.prepend(host);
    // It only helps to complete: where it cannot be written, nothing is lost.
    QDir().mkpath(QFileInfo(fileName()).path());
    (void)saveFile(fileName(), hosts.mid(0, maxHosts).join('\n').toUtf8());
}

QStringList knownHosts(std::chrono::milliseconds timeout) {
    QStringList hosts = reached();
    if (const auto issued = Authority(KeyFolder::usual()).list())
        for (const Authority::Issued &one : *issued)
            if (one.subject.role == PeerCertificate::daemonRole() && !one.isRevoked)
                hosts.append(one.subject.name);
    if (const auto announced = NetworkBrowser().look(timeout))
        for (const QJsonObject &daemon : *announced)
            hosts.append(daemon["host"].toString());
    hosts.removeDuplicates();
    return hosts;
}

} // namespace hermes::ctl

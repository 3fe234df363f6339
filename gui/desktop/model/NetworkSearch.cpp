#include "gui/desktop/model/NetworkSearch.h"

#include <QCoreApplication>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <chrono>

namespace hermes::desktop {
namespace {

constexpr std::chrono::seconds longestSearch{10};
constexpr int maxDaemons = 50;

QString program() {
    const QString beside = QCoreApplication::applicationDirPath() + "/hermesctl";
    return QFile::exists(beside) ? beside : QString("hermesctl");
}

QString addressOf(const QJsonObject &daemon) {
    const QString host = daemon["address"].toString(), framing = daemon["framing"].toString("json");
    return QString("%1://%2:%3?protocol=%4")
        .arg(daemon["tls"].toString() == "yes" ? "tls" : "tcp", host.contains(':') ? '[' + host + ']' : host)
        .arg(daemon["port"].toInt())
        .arg(framing);
}

} // namespace

NetworkSearch::NetworkSearch(QObject *parent)
    : QObject(parent) {
    limit_.setSingleShot(true);
    connect(&limit_, &QTimer::timeout, &process_, &QProcess::kill);
    connect(&process_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
        if (error == QProcess::FailedToStart)
            Q_EMIT failed(
                tr("hermesctl, which looks for robots, cannot be started: %1").arg(process_.errorString()));
    });
    connect(
        &process_, QOverload<int, QProcess::ExitStatus>::of(&QProcess::finished), this,
        [this](int status, QProcess::ExitStatus how) { finish(how == QProcess::NormalExit ? status : 1); });
}

NetworkSearch::~NetworkSearch() {
    process_.disconnect(this);
    process_.kill();
    process_.waitForFinished(1000);
}

void NetworkSearch::start() {
    if (isRunning())
        return;
    process_.start(program(), {"list", "--network", "--json"});
    limit_.start(longestSearch);
}

void NetworkSearch::finish(int status) {
    limit_.stop();
    if (status != 0) {
        process_.readAllStandardError(); // in words of the program, not of who looks for a robot
        return Q_EMIT failed(
            tr("This computer cannot look for robots on the network. Type the address of the "
               "robot into the field above, as 192.168.1.20, and press Add."));
    }
    QStringList urls;
    for (const QJsonValue &daemon : QJsonDocument::fromJson(process_.readAllStandardOutput()).array())
        if (urls.size() < maxDaemons)
            urls.append(addressOf(daemon.toObject()));
    Q_EMIT found(urls);
}

} // namespace hermes::desktop

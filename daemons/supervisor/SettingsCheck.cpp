#include "daemons/supervisor/SettingsCheck.h"

#include "daemons/supervisor/SupervisedProcess.h"

#include <QFile>
#include <QJsonDocument>
#include <QTimer>

namespace hermes::supervisor {
namespace {

constexpr std::chrono::seconds checkTimeout{20}; // with a program on a slow board

} // namespace

SettingsCheck::SettingsCheck(const QJsonObject &settings, Done done, QObject *parent)
    : QObject(parent)
    , settings_(settings)
    , done_(std::move(done))
    , left_(settings.keys()) {
    QTimer::singleShot(0, this, &SettingsCheck::next);
}

void SettingsCheck::next() {
    if (left_.isEmpty())
        return tell(complaints_.isEmpty()
                        ? Result<void>()
                        : Error(ErrorCode::InvalidSetting, "nothing was changed: " + complaints_.join("; ")));
    if (!folder_.isValid())
        return tell(Error(ErrorCode::InputOutput, folder_.errorString()));
    const QString daemon = left_.takeFirst();
    const QString name = folder_.filePath(daemon + ".json");
    QFile file(name);
    const QByteArray text = QJsonDocument(settings_[daemon].toObject()).toJson();
    if (!file.open(QIODevice::WriteOnly) || file.write(text) != text.size() || !file.flush())
        return tell(Error(ErrorCode::InputOutput, QString("%1: %2").arg(name, file.errorString())));
    auto *const process = new QProcess(this);
    process->setProcessChannelMode(QProcess::MergedChannels);
    connect(process, &QProcess::errorOccurred, this, [=](QProcess::ProcessError error) {
        if (error == QProcess::FailedToStart)
            onEnded(daemon, process->program() + ": " + process->errorString());
    });
    connect(
        process, QOverload<int, QProcess::ExitStatus>::of(&QProcess::finished), this,
        [=](int code, QProcess::ExitStatus status) {
            const bool isFine = status == QProcess::NormalExit && code == 0;
            QString said = QString::fromUtf8(process->readAll()).trimmed();
            said.replace(folder_.path() + '/', ""); // where it lies for the check is nobody's concern
            onEnded(daemon, isFine ? QString() : said.isEmpty() ? "the check did not end in order" : said);
        });
    QTimer::singleShot(checkTimeout, process, &QProcess::kill);
    process->start(SupervisedProcess::found("hermes-" + daemon), {"--check", "--config", name});
}

void SettingsCheck::onEnded(const QString &daemon, const QString &failure) {
    if (!failure.isEmpty())
        complaints_.append(daemon + ": " + failure);
    next();
}

void SettingsCheck::tell(const Result<void> &result) {
    done_(result);
    deleteLater();
}

} // namespace hermes::supervisor

#pragma once

#include "common/Result.h"

#include <QJsonObject>
#include <QObject>
#include <QProcess>
#include <QStringList>
#include <QTemporaryDir>
#include <functional>

namespace hermes::supervisor {

/// Asks each daemon whether it would take these settings (hermes-NAME --check), one after another, without
/// waiting. Deletes itself when it has told.
class SettingsCheck : public QObject {
    Q_OBJECT
public:
    using Done = std::function<void(const Result<void> &)>;

    /// settings: by daemons. done gets an error with what each of those that refuse says.
    SettingsCheck(const QJsonObject &settings, Done done, QObject *parent);

private:
    void next();
    void onEnded(const QString &daemon, const QString &failure);
    void tell(const Result<void> &result);

    const QJsonObject settings_;
    const Done done_;
    QStringList left_;
    QStringList complaints_;
    QTemporaryDir folder_;
};

} // namespace hermes::supervisor

#pragma once

#include "common/daemon/AuditFile.h"
#include "common/daemon/Command.h"
#include "protocol/jsonrpc/JsonRpc.h"

#include <QMap>
#include <QObject>
#include <QTimer>

namespace hermes {

/// Who commanded what, and when: a line of JSON for each command that changes something or stops, also where
/// it is refused. Of set-points and stops that a client sends again and again, and of what observers send
/// and what is refused for the role, one line a second, which says how many they were.
class Audit : public QObject {
    Q_OBJECT
public:
    explicit Audit(QObject *parent);
    ~Audit() override { writeRepeated(); }

    /// Where to write, AuditFile; an empty folder: nowhere.
    void open(const QString &folder, const QString &name, qint64 bytes, int files);
    /// After a command was carried out or refused.
    void note(const Call &call, const Command &command, const QJsonValue &params,
              const Result<QJsonValue> &result);
    /// Of the file; nothing: there is none.
    std::optional<AuditFile::State> state() const;
    QString path() const { return file_ ? file_->path() : QString(); }
    /// $STATE_DIRECTORY of the service manager, else hermes in the user's folder of state.
    static QString usualFolder();

private:
    struct Repeated {
        QJsonObject last;
        int calls = 0;
    };

    void writeRepeated();

    std::unique_ptr<AuditFile> file_;
    QMap<QString, Repeated> repeated_; // by client and method, of the last second
    QTimer timer_;
};

} // namespace hermes

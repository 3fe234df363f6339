#pragma once

#include "common/daemon/AuditFile.h"
#include "common/daemon/Command.h"
#include "protocol/messages/Daemons.h"

#include <QMap>
#include <QObject>
#include <QTimer>

namespace hermes {

/// Who commanded what, and when: a line of JSON for each command that changes something or stops, also where
/// it is refused. Some are summed up, by client and command: one line says how many they were. It comes after
/// a second, then after twice as long each time, at last once a minute. So it is with set-points and stops
/// that a client sends again and again, with what observers send and what is refused for the role, and with
/// everything once a quarter of the files was written within a day: nobody is to push out what was told
/// before.
class Audit : public QObject {
    Q_OBJECT
public:
    explicit Audit(QObject *parent);
    ~Audit() override { writeRepeated(true); }

    /// Where to write, AuditFile; an empty folder: nowhere.
    void open(const QString &folder, const QString &name, qint64 bytes, int files);
    /// After a command was carried out or refused.
    void note(const Call &call, const Command &command, const QJsonValue &params,
              const Result<QJsonValue> &result);
    /// Of the file; nothing: there is none.
    std::optional<AuditFile::State> state() const;
    QString path() const { return file_ ? file_->path() : QString(); }
    /// Whether there were so many commands in the last minute that all are summed up.
    bool isFlooded() const;
    /// $STATE_DIRECTORY of the service manager, else hermes in the user's folder of state.
    static QString usualFolder();

Q_SIGNALS:
    /// An entry, also where no file is written.
    void noted(const hermes::CommandMessage &entry);

private:
    struct Repeated {
        CommandMessage last;
        int calls = 0;
        double period_s = 1;
        double due = 0; ///< of monotonicNow()
    };

    void append(const CommandMessage &entry);
    void writeRepeated(bool all);
    void fillAllowance();

    std::unique_ptr<AuditFile> file_;
    QMap<QString, Repeated> repeated_; ///< by client and method
    QTimer timer_;
    double maxBytes_ = 0;  ///< to be written at once
    double allowance_ = 0; ///< what is left of that
    double filled_ = 0;    ///< when; of monotonicNow()
    double summedUp_ = -1e9;
};

} // namespace hermes

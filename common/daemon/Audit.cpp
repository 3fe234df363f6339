#include "common/daemon/Audit.h"

#include "common/Time.h"
#include "common/files/Folder.h"
#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <chrono>

namespace hermes {
namespace {

constexpr int longestParams = 2048; // bytes in a line; to write more takes long, too
constexpr int mostRepeated = 100;   // clients and methods
constexpr std::chrono::seconds period{1};

// Takes from left about as many bytes as the value has when it is written; stops when nothing is left.
void takeFrom(int &left, const QJsonValue &value) {
    constexpr int ofNumber = 4;
    left -= ofNumber;
    if (value.isString()) {
        left -= value.toString().size();
    } else if (value.isArray()) {
        const QJsonArray array = value.toArray();
        for (int i = 0; i < array.size() && left >= 0; ++i)
            takeFrom(left, array.at(i));
    } else if (value.isObject()) {
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end() && left >= 0; ++member) {
            left -= member.key().size();
            takeFrom(left, member.value());
        }
    }
}

QJsonObject entryOf(const Call &call, const Command &command, const QJsonValue &params,
                    const Result<QJsonValue> &result) {
    QJsonObject entry{{QStringLiteral("stamp"), stampNow()},
                      {QStringLiteral("client"), call.clientName},
                      {QStringLiteral("role"), toString(call.role)},
                      {QStringLiteral("method"), command.name()}};
    int left = longestParams;
    takeFrom(left, params);
    if (left < 0)
        entry.insert(QStringLiteral("params"), QStringLiteral("too long for the audit"));
    else if (!params.isUndefined())
        entry.insert(QStringLiteral("params"), params);
    if (!result) {
        entry.insert(QStringLiteral("error"), result.error().code);
        entry.insert(QStringLiteral("message"), result.error().message.left(longestParams));
    }
    return entry;
}

} // namespace

Audit::Audit(QObject *parent)
    : QObject(parent) {
    connect(&timer_, &QTimer::timeout, this, &Audit::writeRepeated);
}

QString Audit::usualFolder() {
    return stateFolder() + QStringLiteral("/audit");
}

void Audit::open(const QString &folder, const QString &name, qint64 bytes, int files) {
    writeRepeated();
    file_ = folder.isEmpty() ? nullptr : std::make_unique<AuditFile>(folder, name, bytes, files);
}

std::optional<AuditFile::State> Audit::state() const {
    return file_ ? std::optional(file_->state()) : std::nullopt;
}

void Audit::note(const Call &call, const Command &command, const QJsonValue &params,
                 const Result<QJsonValue> &result) {
    if (!file_ || !command.isAudited())
        return;
    const QJsonObject entry = entryOf(call, command, params, result);
    const bool isForRole = !result && result.error().is(ErrorCode::NotAuthorised);
    // Anybody can come again under another name, and would bury what others did.
    const bool isAnybody = isForRole || call.role == Role::Observer;
    if (!isAnybody && !command.isSetPoint() && !command.isUrgent())
        return file_->append(compactJson(entry));
    const QString key = (isAnybody ? QString() : call.clientName) + QLatin1Char('\n') + command.name();
    if (repeated_.size() >= mostRepeated && !repeated_.contains(key))
        writeRepeated();
    const bool isFirst = !repeated_.contains(key);
    Repeated &known = repeated_[key];
    if (isFirst) {
        file_->append(compactJson(entry));
        if (!timer_.isActive())
            timer_.start(period);
        return;
    }
    known.last = entry;
    ++known.calls;
}

// Those that were silent for a period begin anew.
void Audit::writeRepeated() {
    for (auto known = repeated_.begin(); known != repeated_.end();) {
        if (known->calls == 0) {
            known = repeated_.erase(known);
            continue;
        }
        known->last.insert(QStringLiteral("calls"), known->calls);
        if (file_)
            file_->append(compactJson(known->last));
        known->calls = 0;
        ++known;
    }
    if (repeated_.isEmpty())
        timer_.stop();
}

} // namespace hermes

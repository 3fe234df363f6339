#include "common/daemon/Audit.h"

#include "common/Time.h"
#include "common/files/Folder.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"

#include <QJsonArray>
#include <algorithm>
#include <chrono>

namespace hermes {
namespace {

constexpr int longestParams = 2048; // bytes in a line; to write more takes long, too
constexpr int maxRepeated = 100;    // clients and methods
constexpr std::chrono::seconds period{1};
constexpr double longestPeriod_s = 60, day_s = 86400;
constexpr double leastBytes = 65536; // that are written at once

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

/// The beginnings of what it holds; of an object what is short comes before lists.
QJsonValue shortened(const QJsonValue &value, int &left) {
    constexpr int longestAuditText = 200, maxMembers = 8;
    left -= 1;
    if (value.isString()) {
        const QString text = value.toString(), begin = text.left(std::clamp(left, 0, longestAuditText));
        left -= begin.size();
        return begin.size() < text.size() ? begin + QStringLiteral("... (%1)").arg(text.size()) : text;
    }
    if (value.isArray()) {
        const QJsonArray array = value.toArray();
        QJsonArray result;
        while (result.size() < std::min(array.size(), maxMembers) && left > 0)
            result.append(shortened(array.at(result.size()), left));
        if (result.size() < array.size())
            result.append(QStringLiteral("... (%1)").arg(array.size()));
        return result;
    }
    if (!value.isObject())
        return value;
    const QJsonObject object = value.toObject();
    QJsonObject result;
    for (const bool isContainer : {false, true})
        for (auto member = object.begin(); member != object.end() && left > 0; ++member)
            if ((member->isArray() || member->isObject()) == isContainer) {
                const QString key = member.key().left(longestAuditText);
                left -= key.size();
                result.insert(key, shortened(member.value(), left));
            }
    if (result.size() < object.size())
        result.insert(QStringLiteral("..."), object.size());
    return result;
}

CommandMessage entryOf(const Call &call, const Command &command, const QJsonValue &params,
                       const Result<QJsonValue> &result) {
    CommandMessage entry{stampNow(), call.clientName, toString(call.role), command.name(), {}, {}, {}, {}};
    int left = longestParams;
    takeFrom(left, params);
    const bool isLong = left < 0;
    left = longestParams;
    if (!params.isUndefined())
        entry.params = isLong ? shortened(params, left) : params;
    if (!result) {
        entry.error = result.error().code;
        entry.message = result.error().message.left(longestParams);
    }
    return entry;
}

} // namespace

Audit::Audit(QObject *parent)
    : QObject(parent) {
    connect(&timer_, &QTimer::timeout, this, [this] { writeRepeated(false); });
}

QString Audit::usualFolder() {
    return stateFolder() + QStringLiteral("/audit");
}

void Audit::open(const QString &folder, const QString &name, qint64 bytes, int files) {
    writeRepeated(true);
    file_ = folder.isEmpty() ? nullptr : std::make_unique<AuditFile>(folder, name, bytes, files);
    maxBytes_ = allowance_ = std::max(leastBytes, double(bytes) * files / 4);
    filled_ = monotonicNow();
}

std::optional<AuditFile::State> Audit::state() const {
    return file_ ? std::optional(file_->state()) : std::nullopt;
}

bool Audit::isFlooded() const {
    return monotonicNow() - summedUp_ < longestPeriod_s;
}

void Audit::fillAllowance() {
    const double now = monotonicNow();
    allowance_ = std::min(maxBytes_, allowance_ + (now - filled_) * maxBytes_ / day_s);
    filled_ = now;
}

void Audit::append(const CommandMessage &entry) {
    const QByteArray line = compactJson(asJson(entry));
    allowance_ = std::max(0.0, allowance_ - line.size());
    if (file_)
        file_->append(line);
    Q_EMIT noted(entry);
}

void Audit::note(const Call &call, const Command &command, const QJsonValue &params,
                 const Result<QJsonValue> &result) {
    if (!command.isAudited())
        return;
    CommandMessage entry = entryOf(call, command, params, result);
    const bool isForRole = !result && result.error().is(ErrorCode::NotAuthorised);
    // Anybody can come again under another name, and would bury what others did.
    const bool isAnybody = isForRole || call.role == Role::Observer;
    fillAllowance();
    const bool isMuch = allowance_ < longestParams || (file_ && file_->isSlow());
    if (!isMuch && !isAnybody && !command.isSetPoint() && !command.isUrgent())
        return append(entry);
    if (isMuch) {
        summedUp_ = filled_;
        entry.params.reset();
        entry.message.reset();
    }
    QString key = (isAnybody ? QString() : call.clientName) + QLatin1Char('\n') + command.name();
    if (repeated_.size() >= maxRepeated && !repeated_.contains(key))
        key = QLatin1Char('\n') + command.name(); // of several clients: commands are not without number
    const bool isFirst = !repeated_.contains(key);
    Repeated &known = repeated_[key];
    if (isFirst) {
        known.period_s = isMuch ? longestPeriod_s : 1;
        known.due = filled_ + known.period_s;
        if (!timer_.isActive())
            timer_.start(period);
        return append(entry);
    }
    known.last = entry;
    ++known.calls;
}

// Those that were silent for their period begin anew.
void Audit::writeRepeated(bool all) {
    const double now = monotonicNow();
    for (auto known = repeated_.begin(); known != repeated_.end();) {
        if (known->due > now && !all) {
            ++known;
            continue;
        }
        if (known->calls == 0) {
            known = repeated_.erase(known);
            continue;
        }
        known->last.calls = known->calls;
        append(known->last);
        known->calls = 0;
        known->period_s = std::min(2 * known->period_s, longestPeriod_s);
        known->due = now + known->period_s;
        ++known;
    }
    if (repeated_.isEmpty())
        timer_.stop();
}

} // namespace hermes

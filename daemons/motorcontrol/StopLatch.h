#pragma once

#include <QMap>
#include <QString>

namespace hermes::motorcontrol {

/// What keeps the robot from moving until somebody releases it: the emergency stop and the faults, each with
/// its reason. A cause that is there already keeps its first reason.
class StopLatch {
public:
    /// True when the cause is new.
    bool set(const QString &cause, const QString &reason) {
        if (causes_.contains(cause))
            return false;
        causes_.insert(cause, reason);
        return true;
    }
    void release() { causes_.clear(); }

    bool isSet() const { return !causes_.isEmpty(); }
    bool has(const QString &cause) const { return causes_.contains(cause); }
    QString reason(const QString &cause) const { return causes_.value(cause); }
    /// All reasons as one sentence.
    QString text() const { return causes_.values().join("; "); }
    /// The reason of each.
    const QMap<QString, QString> &causes() const { return causes_; }

private:
    QMap<QString, QString> causes_;
};

} // namespace hermes::motorcontrol

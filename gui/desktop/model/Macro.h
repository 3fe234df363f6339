#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QJsonArray>
#include <vector>

namespace hermes::desktop {

/// One command to a daemon of a robot, and how long to wait after its answer.
struct MacroStep {
    static constexpr double longestPause_s = 3600;
    static constexpr int maxParams = 20000; ///< bytes, as the layout keeps them

    QString robot, daemon, method;
    QJsonObject params;
    double pause_s = 0;

    static MacroStep of(const Fleet &fleet, const DaemonLink &daemon, const QString &method,
                        const QJsonObject &params);
    /// Null: there is none of that name at that robot, or more than one.
    DaemonLink *target(const Fleet &fleet) const;
    /// "motorcontrol, motor.stop"
    QString title() const { return daemon + ", " + method; }
    /// Why it cannot be kept; empty: it can.
    QString problem() const;
};

/// Commands under one name, run one after the other.
struct Macro {
    static constexpr int longestName = 40, maxSteps = 50;

    QString name;
    std::vector<MacroStep> steps;

    QJsonObject toJson() const;
    /// Whatever is there: what is nonsense in it is left out.
    static Macro from(const QJsonObject &json);
};

/// The operator's own buttons, in their order, each with a command or several.
class Buttons : public QObject {
    Q_OBJECT
public:
    static constexpr int most = 60;

    using QObject::QObject;

    const std::vector<Macro> &all() const { return macros_; }
    bool isFull() const { return int(macros_.size()) >= most; }
    void add(const Macro &macro);
    /// In place of the one that is there.
    void set(int place, const Macro &macro);
    void remove(int place);
    void move(int place, int by);

    /// To be kept between runs.
    QJsonArray state() const;
    /// Of whatever was kept.
    void setState(const QJsonArray &state);

Q_SIGNALS:
    void changed();

private:
    std::vector<Macro> macros_;
};

} // namespace hermes::desktop

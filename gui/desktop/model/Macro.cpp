#include "gui/desktop/model/Macro.h"

#include "gui/desktop/widgets/ForeignText.h"

#include <QJsonDocument>
#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr int longestPlace = 200, longestStepTitle = 80;

QString text(const QJsonValue &value, int longest) {
    return shortLine(value.toString(), longest);
}

QByteArray compact(const QJsonDocument &json) {
    return json.toJson(QJsonDocument::Compact);
}

} // namespace

MacroStep MacroStep::of(const Fleet &fleet, const DaemonLink &daemon, const QString &method,
                        const QJsonObject &params) {
    const Robot *const robot = fleet.robotOf(&daemon);
    return {robot ? robot->id() : daemon.host(), daemon.name(), method, params};
}

DaemonLink *MacroStep::target(const Fleet &fleet) const {
    std::vector<DaemonLink *> found;
    if (const Robot *const one = fleet.robotAt(robot))
        for (DaemonLink *const link : one->daemons())
            if (link->name() == daemon)
                found.push_back(link);
    return found.size() == 1 ? found.front() : nullptr; // of two nobody knows which was meant
}

QString MacroStep::problem() const {
    const int bytes = compact(QJsonDocument(params)).size();
    if (bytes > maxParams)
        return QObject::tr("The parameters of %1 have %2 bytes; a button keeps %3 at most.")
            .arg(shortLine(title(), longestStepTitle))
            .arg(bytes)
            .arg(maxParams);
    for (const QString &name : {robot, daemon, method})
        if (text(name, longestPlace) != name)
            return QObject::tr("%1 has a name of %2 characters; a button keeps one line of %3 at most.")
                .arg(shortLine(name, longestStepTitle))
                .arg(name.size())
                .arg(longestPlace);
    const QJsonArray kept{Macro{{}, {*this}}.toJson()};
    if (QJsonDocument::fromJson(compact(QJsonDocument(kept))).isNull())
        return QObject::tr("The parameters of %1 have too many lists in lists; a button keeps 1000 in each "
                           "other at most.")
            .arg(shortLine(title(), longestStepTitle));
    return {};
}

QJsonObject Macro::toJson() const {
    QJsonArray list;
    for (const MacroStep &step : steps)
        list.append(QJsonObject{{"robot", step.robot},
                                {"daemon", step.daemon},
                                {"method", step.method},
                                {"params", step.params},
                                {"pause_s", step.pause_s}});
    return {{"name", name}, {"steps", list}};
}

Macro Macro::from(const QJsonObject &json) {
    Macro macro{text(json["name"], longestName), {}};
    for (const QJsonValue &value : json["steps"].toArray()) {
        MacroStep step{text(value["robot"], longestPlace), text(value["daemon"], longestPlace),
                       text(value["method"], longestPlace), value["params"].toObject(),
                       qBound(0.0, value["pause_s"].toDouble(), MacroStep::longestPause_s)};
        if (int(macro.steps.size()) < maxSteps && !step.method.isEmpty() && step.problem().isEmpty())
            macro.steps.push_back(step);
        else
            return {macro.name, {}}; // a part of it would be something else
    }
    return macro;
}

void Buttons::add(const Macro &macro) {
    if (isFull())
        return;
    macros_.push_back(macro);
    Q_EMIT changed();
}

void Buttons::set(int place, const Macro &macro) {
    macros_.at(std::size_t(place)) = macro;
    Q_EMIT changed();
}

void Buttons::remove(int place) {
    macros_.erase(macros_.begin() + place);
    Q_EMIT changed();
}

void Buttons::move(int place, int by) {
    const int to = place + by;
    if (place < 0 || to < 0 || std::max(place, to) >= int(macros_.size()))
        return;
    std::swap(macros_[std::size_t(place)], macros_[std::size_t(to)]);
    Q_EMIT changed();
}

QJsonArray Buttons::state() const {
    QJsonArray list;
    for (const Macro &macro : macros_)
        list.append(macro.toJson());
    return list;
}

void Buttons::setState(const QJsonArray &state) {
    macros_.clear();
    for (const QJsonValue &value : state)
        if (Macro macro = Macro::from(value.toObject());
            !isFull() && !macro.steps.empty() && !macro.name.isEmpty())
            macros_.push_back(std::move(macro));
    Q_EMIT changed();
}

} // namespace hermes::desktop

#include "common/OwnRobot.h"

#include <QUuid>
#include <QVector>
#include <algorithm>

namespace hermes {
namespace {

QString tellable(const QString &name) {
    QVector<uint> characters = name.simplified().toUcs4();
    characters.erase(std::remove_if(characters.begin(), characters.end(),
                                    [](uint character) { return !QChar::isPrint(character); }),
                     characters.end());
    return QString::fromUcs4(characters.constData(), std::min(characters.size(), longestRobotName)).trimmed();
}

} // namespace

bool isRobotId(const QString &text) {
    const QUuid id(text);
    return !id.isNull() && id.toString(QUuid::WithoutBraces) == text.toLower();
}

std::optional<RobotIdentity> ownRobot() {
    const QString told = qEnvironmentVariable(robotVariable);
    const RobotIdentity robot{told.section(QLatin1Char(' '), 0, 0).toLower(),
                              told.section(QLatin1Char(' '), 1)};
    if (!isRobotId(robot.id) || robot.name.isEmpty() || robot.name != tellable(robot.name))
        return std::nullopt;
    return robot;
}

void setOwnRobot(const RobotIdentity &robot) {
    qputenv(robotVariable, (robot.id + QLatin1Char(' ') + tellable(robot.name)).toUtf8());
}

} // namespace hermes

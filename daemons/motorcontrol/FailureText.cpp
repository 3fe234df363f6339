#include "daemons/motorcontrol/FailureText.h"

namespace hermes::motorcontrol {

using drive::Bus;

QString failureText(const drive::MotorDevice::Name &name, Bus::Result result, bool heard) {
    const QString command = QString::fromStdString(name.command);
    switch (result) {
    case Bus::Result::BadCrc:
        return "answers with a wrong checksum";
    case Bus::Result::Unexpected:
        return QString("answers command %1 with something unexpected").arg(command);
    case Bus::Result::LineClosed:
        return "has no line";
    default:
        break;
    }
    if (!heard)
        return "does not answer" + QString::fromStdString(name.ifSilent);
    const QString text = QString("answers, but not command %1").arg(command);
    return name.ifUnknown.empty() ? text : text + ": " + QString::fromStdString(name.ifUnknown);
}

} // namespace hermes::motorcontrol

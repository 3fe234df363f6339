#pragma once

#include "common/Result.h"

#include <QJsonObject>

namespace hermes {

/// An error of the disk: InputOutput with data.path.
inline Error diskError(const QString &message, const QString &path) {
    return Error(ErrorCode::InputOutput, message, QJsonObject{{"path", path}});
}

} // namespace hermes

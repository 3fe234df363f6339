#pragma once

#include "common/Result.h"

#include <QByteArray>
#include <QString>

namespace hermes {

/// What a folder of keys holds (KeyFolder), as it travels to whom it was issued for.
struct KeyBundle {
    QByteArray authority, certificate, key; ///< PEM
    QByteArray revoked;                     ///< serial numbers, one a line; empty: there are none

    static constexpr int maxJsonBytes = 2 << 20;

    /// Of what people have written beside the serial numbers, nothing.
    static Result<KeyBundle> read(const QString &folder);
    /// Checks all that came from elsewhere: one PEM each and nothing beside it, the key belongs to the
    /// certificate, the authority has signed it, and it names somebody with a role.
    static Result<KeyBundle> fromJson(const QByteArray &json);
    QByteArray toJson() const;
    /// Into a folder that exists; the names of the files are those of KeyFolder.
    Result<void> write(const QString &folder) const;
};

} // namespace hermes

#pragma once

#include "common/Result.h"
#include "gui/hermesctl/PairingSecret.h"

#include <QByteArray>
#include <QString>

namespace hermes::ctl {

/// What people carry from one computer to another: 10 characters, 50 bits, good for one pairing.
class PairingCode {
public:
    /// From the system's generator. Error: it gives nothing.
    static Result<PairingCode> make();
    /// As people type it: small letters, spaces and hyphens anywhere. Error: what is wrong with it.
    static Result<PairingCode> read(const QString &typed);

    /// Two groups of five, with a hyphen between.
    QString text() const;
    /// The key that both sides make of it; slowly, so that who has pretended to be the other
    /// side cannot try all codes while one is good.
    Result<PairingSecret> secret() const;

private:
    explicit PairingCode(QByteArray characters)
        : characters_(std::move(characters)) {}

    QByteArray characters_;
};

} // namespace hermes::ctl

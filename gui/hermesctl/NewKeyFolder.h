#pragma once

#include "common/tls/KeyBundle.h"

#include <QTemporaryDir>
#include <memory>

namespace hermes::ctl {

/// A folder of keys that comes into being whole, or not at all: it is written beside its place, and put there
/// in the end. What was not kept is removed; what this one has not made is left alone.
class NewKeyFolder {
public:
    explicit NewKeyFolder(const QString &place);

    /// Error: there are keys already, or something else.
    Result<void> check() const;
    /// Error also when programs could not use them: KeyFolder::load().
    Result<void> stage(const KeyBundle &keys);
    Result<void> keep();

private:
    const QString place_;
    std::unique_ptr<QTemporaryDir> staged_;
};

} // namespace hermes::ctl

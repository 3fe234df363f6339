#pragma once

#include "common/tls/KeyBundle.h"

namespace hermes::ctl {

/// A folder of keys that comes into being whole, or not at all: it is written beside its place, and put there
/// in the end. What was not kept is removed.
class NewKeyFolder {
public:
    explicit NewKeyFolder(const QString &place);
    ~NewKeyFolder();
    NewKeyFolder(const NewKeyFolder &) = delete;
    NewKeyFolder &operator=(const NewKeyFolder &) = delete;

    /// Error: there are keys already, or something else.
    Result<void> check() const;
    /// Error also when programs could not use them: KeyFolder::load().
    Result<void> stage(const KeyBundle &keys);
    Result<void> keep();

private:
    const QString place_;
    const QString staged_;
    bool isStaged_ = false;
};

} // namespace hermes::ctl

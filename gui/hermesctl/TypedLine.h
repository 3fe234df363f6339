#pragma once

#include "gui/hermesctl/Arguments.h"

namespace hermes::ctl {

/// A command line that is being typed, as far as it goes: from the program's name to the cursor.
struct TypedLine {
    Arguments arguments;   ///< of the words before the last one; only what says whom to ask
    QString current;       ///< the last word, begun or empty
    QString pendingOption; ///< whose value it is, where the option is a word of its own

    static TypedLine read(const QString &line);
    bool isGiven(const QString &name) const; ///< NAME=VALUE stands there
};

} // namespace hermes::ctl

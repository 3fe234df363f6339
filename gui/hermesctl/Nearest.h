#pragma once

#include <QStringList>

namespace hermes::ctl {

/// Those of the names that a person may have meant by a word, the likeliest first; three at most.
QStringList nearest(const QString &word, const QStringList &names);

/// "; did you mean A or B?", or "" where nothing is near.
QString didYouMean(const QString &word, const QStringList &names);

} // namespace hermes::ctl

#pragma once

#include <QStringList>
#include <vector>

namespace hermes::ctl {

/// Prints rows to stdout with columns below each other; the first row is the heading.
void printTable(const std::vector<QStringList> &rows);

} // namespace hermes::ctl

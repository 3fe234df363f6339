#include "gui/hermesctl/Table.h"

#include "gui/hermesctl/Output.h"

namespace hermes::ctl {

void printTable(const std::vector<QStringList> &rows) {
    std::vector<int> widths;
    for (const QStringList &row : rows) {
        widths.resize(std::max(widths.size(), std::size_t(row.size())));
        for (int i = 0; i < row.size(); ++i)
            widths[std::size_t(i)] = std::max(widths[std::size_t(i)], row[i].size());
    }
    for (const QStringList &row : rows) {
        QString line;
        for (int i = 0; i < row.size(); ++i)
            line += row[i].leftJustified(widths[std::size_t(i)] + 2);
        printLine(line.trimmed());
    }
}

} // namespace hermes::ctl

#include "gui/hermesctl/Nearest.h"

#include <algorithm>
#include <vector>

namespace hermes::ctl {
namespace {

/// How many characters have to be put in, left out, changed or swapped with their neighbours.
int distance(const QString &a, const QString &b) {
    std::vector<std::vector<int>> cost(std::size_t(a.size()) + 1,
                                       std::vector<int>(std::size_t(b.size()) + 1));
    for (int i = 0; i <= a.size(); ++i) {
        for (int j = 0; j <= b.size(); ++j) {
            int &here = cost[std::size_t(i)][std::size_t(j)];
            const auto at = [&](int di, int dj) { return cost[std::size_t(i - di)][std::size_t(j - dj)]; };
            if (i == 0 || j == 0) {
                here = i + j;
                continue;
            }
            here = std::min({at(1, 0) + 1, at(0, 1) + 1, at(1, 1) + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                here = std::min(here, at(2, 2) + 1);
        }
    }
    return cost.back().back();
}

/// "pose" of "map.pose", "start" of "record.start".
QString lastPart(const QString &name) {
    return name.section('.', -1);
}

} // namespace

QStringList nearest(const QString &word, const QStringList &names) {
    constexpr int longest = 100;
    constexpr int most = 3;
    if (word.isEmpty() || word.size() > longest)
        return {};
    std::vector<std::pair<int, QString>> found;
    const QString small = word.toLower();
    for (const QString &name : names) {
        const QString other = name.toLower();
        int far = distance(small, other);
        const bool isPart = small.size() >= 3 && (other.contains(small) || small.contains(other));
        if (isPart || lastPart(other) == lastPart(small))
            far = std::min(far, 2);
        if (far <= std::max(2, int(small.size()) / 3) && far < small.size())
            found.emplace_back(far, name);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
    QStringList result;
    for (const auto &[far, name] : found) {
        if (result.size() < most && far <= found.front().first + 1)
            result.append(name);
    }
    return result;
}

QString didYouMean(const QString &word, const QStringList &names) {
    const QStringList near = nearest(word, names);
    return near.isEmpty() ? QString() : QString("; did you mean %1?").arg(near.join(" or "));
}

} // namespace hermes::ctl

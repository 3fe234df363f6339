#include "vectorlib/places/PlaceIndex.h"

#include <utility>

namespace vectorlib {

VECTORLIB_BODY void PlaceIndex::clear() {
    PlaceIndex empty;
    empty.tiles_.mostEntries = tiles_.mostEntries;
    *this = std::move(empty);
}

VECTORLIB_BODY void PlaceIndex::set(int number, const Wall *wall) {
    const auto at = static_cast<std::size_t>(number);
    if (wall && !(wall->isFinite() && wall->length() > 0))
        wall = nullptr; // nobody can see it
    if (at >= walls_.size() && wall)
        walls_.resize(at + 1);
    if (at >= walls_.size())
        return;
    const Known &known = walls_[at];
    const bool isDone = known.isUsed || !isUsable(known.wall);
    if (known.there && wall && isDone && known.wall.begin() == wall->begin() &&
        known.wall.end() == wall->end())
        return;
    if (known.there)
        remove(number);
    if (wall)
        add(number, *wall);
}

VECTORLIB_BODY bool PlaceIndex::isUsable(const Wall &w) {
    const double far =
        std::max({std::abs(w.begin().x), std::abs(w.begin().y), std::abs(w.end().x), std::abs(w.end().y)});
    return w.length() <= longest && far < farthest;
}

VECTORLIB_BODY void PlaceIndex::add(int number, const Wall &wall) {
    const bool isUsed = isUsable(wall) && tiles_.add(number, wall);
    ++size_;
    leftOut_ += !isUsed;
    walls_[static_cast<std::size_t>(number)] = {true, isUsed, wall, isUsed ? alike(wall).size() : 0};
    if (isUsed)
        alike(wall).push_back(number);
}

VECTORLIB_BODY void PlaceIndex::remove(int number) {
    Known &known = walls_[static_cast<std::size_t>(number)];
    known.there = false;
    --size_;
    leftOut_ -= !known.isUsed;
    if (!known.isUsed)
        return;
    std::vector<int> &numbers = alike(known.wall);
    walls_[static_cast<std::size_t>(numbers.back())].place = known.place;
    numbers[known.place] = numbers.back();
    numbers.pop_back();
    tiles_.remove(number);
}

} // namespace vectorlib

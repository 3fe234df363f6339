#include "gui/hermesctl/DriveLine.h"

#include "gui/hermesctl/Nearest.h"

#include <cmath>

namespace hermes::ctl {

const QStringList &velocityNames() {
    static const QStringList names{"vx", "vy", "omega"};
    return names;
}

Result<std::optional<Twist2D>> velocityOf(const Arguments &arguments) {
    const QStringList words = arguments.words.mid(1);
    std::array<std::optional<double>, 3> values;
    for (const QString &word : words) {
        const QString name = word.section('=', 0, 0), text = word.section('=', 1);
        const int place = velocityNames().indexOf(name);
        if (place < 0)
            return Error(ErrorCode::InvalidParams,
                         QString("\"%1\": there is no velocity %2, expected vx, vy or omega%3")
                             .arg(word, name, didYouMean(name, velocityNames())));
        if (values.at(std::size_t(place)))
            return Error(ErrorCode::InvalidParams, QString("%1 is there twice").arg(name));
        bool ok = false;
        const double value = text.toDouble(&ok);
        if (!ok || !std::isfinite(value))
            return Error(ErrorCode::InvalidParams,
                         QString("%1 is \"%2\", expected a number of %3")
                             .arg(name, text, name == "omega" ? QString("rad/s") : QString("m/s")));
        values.at(std::size_t(place)) = value;
    }
    if (words.isEmpty())
        return std::optional<Twist2D>();
    return std::optional<Twist2D>({values[0].value_or(0), values[1].value_or(0), values[2].value_or(0)});
}

} // namespace hermes::ctl

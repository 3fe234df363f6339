#include "gui/desktop/panels/PlotSuggestions.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QGridLayout>
#include <QJsonArray>
#include <QPushButton>
#include <QStyleOptionButton>
#include <QStylePainter>
#include <map>

namespace hermes::desktop {
namespace {

/// Its text ends with "..." where there is no room for it.
class NarrowButton : public QPushButton {
public:
    using QPushButton::QPushButton;

protected:
    void paintEvent(QPaintEvent *) override {
        QStyleOptionButton option;
        initStyleOption(&option);
        const int room = style()->subElementRect(QStyle::SE_PushButtonContents, &option, this).width() -
                         iconSize().width() - 8;
        option.text = fontMetrics().elidedText(option.text, Qt::ElideRight, room, Qt::TextShowMnemonic);
        QStylePainter(this).drawControl(QStyle::CE_PushButton, option);
    }
};

constexpr int maxSuggestions = 6, maxSuggestedFields = 4, maxSeen = 60, longestSuggestion = 48;

/// What operators look at first.
const QStringList units{"m/s", "rad/s", "V", "A", "°C", "m", "rad", "Hz"};

/// "twist.vx" as "vx", "controllers.0.battery_v" as "battery_v".
QString leaf(const QString &path) {
    const QStringList names = path.split('.');
    bool isNumber = false;
    names.last().toUInt(&isNumber);
    return isNumber && names.size() > 1 ? names[names.size() - 2] : names.last();
}

/// A few numbers together say more than one alone; of many none stands out.
int rank(std::size_t count) {
    return count > std::size_t(maxSuggestedFields) ? 2 : count == 1 ? 1 : 0;
}

} // namespace

PlotSuggestions::PlotSuggestions(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , grid_(new QGridLayout) {
    setObjectName("suggestions");
    auto *const text = new PlainLabel(tr("Nothing is plotted. Tick a number on the left, or begin with:"));
    text->setWordWrap(true);
    setLayout(inColumn({text, grid_, Part::room()}));
    connect(&fleet, &Fleet::changed, this, &PlotSuggestions::refresh);
    connect(&fleet, &Fleet::robotChosen, this, &PlotSuggestions::refresh);
    refresh();
}

// One of each unit.
std::vector<PlotSuggestions::Suggestion> PlotSuggestions::find() const {
    std::map<int, Suggestion> best; // by the place of their unit
    for (const DaemonLink *daemon :
         fleet_.robot() ? fleet_.robot()->daemons() : std::vector<DaemonLink *>()) {
        const QJsonArray topics = daemon->description()["x-topics"].toArray();
        for (int i = 0; i < std::min(topics.size(), maxSeen); ++i) {
            const QString topic = topics[i]["name"].toString();
            const QJsonObject schema = topics[i]["schema"].toObject();
            std::map<int, std::vector<FieldId>> found;
            for (const QString &path : numericPaths(schema, maxSeen, UnknownLists::One))
                if (const int unit = units.indexOf(unitAt(schema, path)); unit >= 0)
                    found[unit].push_back({daemon->address(), topic, path});
            for (auto &[unit, fields] : found) {
                Suggestion &known = best[unit];
                if (!known.fields.empty() && rank(known.fields.size()) <= rank(fields.size()))
                    continue;
                known.fields = std::move(fields);
            }
        }
    }
    std::vector<Suggestion> all;
    for (auto &[unit, suggestion] : best) {
        if (int(suggestion.fields.size()) > maxSuggestedFields)
            suggestion.fields.resize(maxSuggestedFields);
        QStringList names;
        for (const FieldId &field : suggestion.fields)
            if (!names.contains(leaf(field.path)))
                names.append(leaf(field.path));
        suggestion.text =
            tr("%1: %2 (%3)").arg(suggestion.fields.front().topic, names.join(", "), units[unit]);
        if (int(all.size()) < maxSuggestions)
            all.push_back(suggestion);
    }
    return all;
}

void PlotSuggestions::refresh() {
    QStringList topics;
    for (const DaemonLink *daemon : fleet_.robot() ? fleet_.robot()->daemons() : std::vector<DaemonLink *>())
        topics.append(QString("%1 %2").arg(daemon->address()).arg(daemon->topics().size()));
    if (std::exchange(topics_, topics) == topics)
        return; // the same descriptions
    const std::vector<Suggestion> suggestions = find();
    QStringList texts;
    for (const Suggestion &suggestion : suggestions)
        texts.append(suggestion.text);
    if (texts == shown_)
        return;
    shown_ = texts;
    while (QLayoutItem *const item = grid_->takeAt(0)) {
        item->widget()->deleteLater();
        delete item;
    }
    for (std::size_t i = 0; i < suggestions.size(); ++i) {
        const QString text = labelText(shortLine(suggestions[i].text, longestSuggestion));
        auto *const button = named(new NarrowButton(theme::icon("plot"), text), "suggestion",
                                   toolTipOf(tr("Plots %1").arg(suggestions[i].text)));
        button->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed); // a long text widens no panel
        connect(button, &QPushButton::clicked, this,
                [this, fields = suggestions[i].fields] { Q_EMIT wanted(fields); });
        grid_->addWidget(button, int(i) / 2, int(i) % 2);
    }
}

} // namespace hermes::desktop

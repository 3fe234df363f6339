#include "gui/desktop/panels/EventsPanel.h"

#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QCheckBox>
#include <QComboBox>
#include <QHeaderView>
#include <QPushButton>
#include <QTreeView>

namespace hermes::desktop {

EventsPanel::EventsPanel(Events &events, Sounds &sounds, QWidget *parent)
    : QWidget(parent)
    , events_(events)
    , table_(events, this)
    , view_(named(new QTreeView, "events")) {
    auto *const level = named(new QComboBox, "eventLevel");
    level->addItems({tr("all"), tr("warnings and errors"), tr("errors")});
    auto *const sound =
        named(new QCheckBox(tr("Sounds")), "sounds",
              tr("The desktop's bell at each new error, and each second while a STOP is not confirmed"));
    sound->setChecked(sounds.areOn());
    auto *const chosen =
        named(new QPushButton(tr("Acknowledge")), "acknowledgeChosen", tr("The chosen events"));
    auto *const all = named(new QPushButton(tr("Acknowledge all")), "acknowledgeAll");
    view_->setAccessibleName(tr("Events"));
    view_->setModel(&table_);
    view_->setRootIsDecorated(false);
    view_->setUniformRowHeights(true);
    view_->setSelectionMode(QAbstractItemView::ExtendedSelection);
    view_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
    view_->header()->setSectionResizeMode(EventTable::TextColumn, QHeaderView::Stretch);
    view_->header()->setStretchLastSection(false);

    auto *const label = new PlainLabel(tr("Show"));
    label->setBuddy(level);
    setLayout(inColumn({inRow({label, level, sound, Part::room(), chosen, all}), view_}));

    connect(level, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            [this](int least) { table_.show(Event::Level(least)); });
    connect(sound, &QCheckBox::toggled, this, [&sounds](bool on) { sounds.switchTo(on); });
    connect(chosen, &QPushButton::clicked, this, &EventsPanel::acknowledgeChosen);
    connect(all, &QPushButton::clicked, &events, &Events::acknowledgeAll);
    // What is chosen stays so while others come.
    connect(&table_, &EventTable::modelAboutToBeReset, this, [this] {
        chosen_.clear();
        for (const QModelIndex &row : view_->selectionModel()->selectedRows())
            chosen_.insert(row.data(EventTable::IdRole).toULongLong());
    });
    connect(&table_, &EventTable::modelReset, this, [this] {
        for (int row = 0; row < table_.rowCount() && !chosen_.isEmpty(); ++row)
            if (const QModelIndex index = table_.index(row, 0);
                chosen_.contains(index.data(EventTable::IdRole).toULongLong()))
                view_->selectionModel()->select(index,
                                                QItemSelectionModel::Select | QItemSelectionModel::Rows);
    });
}

void EventsPanel::acknowledgeChosen() {
    for (const QModelIndex &row : view_->selectionModel()->selectedRows())
        events_.acknowledge(row.data(EventTable::IdRole).toULongLong());
}

} // namespace hermes::desktop

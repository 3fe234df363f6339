#include "gui/desktop/panels/PlotMenu.h"

#include "gui/desktop/panels/PlotBoard.h"
#include "gui/desktop/view/PlotPane.h"

#include <QMenu>

namespace hermes::desktop {
namespace {

void addAxes(QMenu &menu, PlotBoard &board, const PlotPane &pane) {
    auto *const axes = menu.addMenu(QObject::tr("Axis on the right"));
    for (const PlotLine &line : pane.scene().lines) {
        QAction *const right = axes->addAction(QString(line.name).replace('&', "&&"));
        right->setCheckable(true);
        right->setChecked(line.isRight);
        QObject::connect(right, &QAction::toggled, &board,
                         [&board, field = line.field](bool isRight) { board.setRight(field, isRight); });
    }
    axes->setEnabled(!axes->isEmpty());
}

} // namespace

void openPlotMenu(PlotBoard &board, const PlotPane &pane, const QPoint &global) {
    auto *const menu = new QMenu(&board);
    menu->setAttribute(Qt::WA_DeleteOnClose);
    menu->addAction(QObject::tr("Live"), &board, &PlotBoard::goLive);
    addAxes(*menu, board, pane);
    auto *const remove = menu->addMenu(QObject::tr("Remove a curve"));
    for (const PlotLine &line : pane.scene().lines)
        remove->addAction(QString(line.name).replace('&', "&&"), &board,
                          [&board, field = line.field] { board.remove(field); });
    remove->setEnabled(!remove->isEmpty());
    menu->addSeparator();
    menu->addAction(QObject::tr("Add a pane"), &board, &PlotBoard::addPane)->setEnabled(board.canAddPane());
    const bool isOnly = board.panes().size() == 1;
    menu->addAction(isOnly ? QObject::tr("Remove all curves") : QObject::tr("Remove this pane"), &board,
                    &PlotBoard::removePane);
    menu->popup(global);
}

} // namespace hermes::desktop

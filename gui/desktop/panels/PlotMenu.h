#pragma once

#include <QPoint>

namespace hermes::desktop {

class PlotBoard;
class PlotPane;

/// Opens the menu of one chart: its curves, their axes, and the charts.
void openPlotMenu(PlotBoard &board, const PlotPane &pane, const QPoint &global);

} // namespace hermes::desktop

#pragma once
// The published tables beside the runs that stand for them: what fit, validate and reproduce start from.
#include <string>
#include <vector>

#include "cost_models/experiment.h"
#include "lab/base/observer.h"
#include "lab/base/table.h"
#include "lab/point/session.h"

namespace hwsim::lab {

/// What is asked of the lab to have a run's work. Throws InputError for settings that no request takes.
Request request_of(const cost_models::RunSpec& run);

/// Rows of the papers (all when empty) with what is done with them, from the published tables of `folder`. A
/// paper is called as its tables call it, in any case. Throws InputError U003 for one that has no table.
std::vector<cost_models::Cell> published_cells(const std::vector<std::string>& papers,
                                               const ConfigFolder& folder);

/// Gives a run the trace that `run` would make, from the cache where it is there. `cache` and `observer` must
/// outlive it.
cost_models::TraceSource emulated_traces(int jobs, const Cache& cache, Observer& observer);

/// The cells with what predicts them. Rows that cannot run are in `not_run`.
cost_models::Experiment load_experiment(std::vector<cost_models::Cell> cells,
                                        const cost_models::TraceSource& traces, const ConfigFolder& folder,
                                        Observer& observer);

/// The same for rows of the papers, from emulated traces.
cost_models::Experiment load_experiment(const std::vector<std::string>& papers, Session& session);

/// Rows and their runs, without running anything.
Table plan_table(const std::vector<cost_models::Cell>& cells);

/// Rows that have no prediction, by reason.
Table not_run_table(const cost_models::Experiment& experiment);

}  // namespace hwsim::lab

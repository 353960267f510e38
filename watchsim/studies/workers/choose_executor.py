"""In this process, in several, or on a cluster?"""

from __future__ import annotations

from watchsim.studies.workers.executor import Executor, Here


def chosen(workers: int, scheduler: str | None) -> Executor:
    """The executor for so many processes, or for the cluster with a scheduler at that address."""
    if scheduler is not None:
        from watchsim.studies.workers.cluster import Cluster

        return Cluster(scheduler)
    if workers <= 1:
        return Here()
    from watchsim.studies.workers.processes import Processes

    return Processes(workers)

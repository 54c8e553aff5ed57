"""The campaign that a study flies, checked before anything flies."""

from armland.errors import ConfigurationError
from armland.experiments.campaign.description import check_parameters
from armland.experiments.campaign.engine import Campaign
from armland.experiments.campaign.flight import prepared
from armland.experiments.campaign.rows import Job
from armland.experiments.judge.figures import bounds
from armland.experiments.study.table import Study, describe
from armland.scenario import Scenario
from armland.scenario.refusal import refused


def campaign_of_study(study: Study, scenario: Scenario, file: str, runs: int, first: int) -> Campaign:
    """The campaign of a study.

    Args:
        study: what is asked.
        scenario: which is changed, as it flies.
        file: its name.
        runs: flights of each change.
        first: seed of the first.

    Raises:
        ConfigurationError: all changes that the scenario, or a flight in it, refuses.
    """
    described = describe(study, scenario, file, first)
    check_parameters(described, scenario)
    campaign = Campaign(described, Job(scenario.frozen(), "landing"), runs, {})
    found, limits = list[str](), dict[str, float]()
    for k, variant in enumerate(described.variants):
        try:
            flight = prepared(campaign.job, campaign.schedule.task(k))
        except ConfigurationError as e:
            line = f"{variant.name}: {e}"
            if k == 0:
                raise ConfigurationError(line) from e
            found.append(line)
        else:
            limits = limits or bounds(flight.brief)
    if found:
        raise refused(f"the study {study.name}; --only flies the others", found)
    return campaign._replace(bounds=limits)

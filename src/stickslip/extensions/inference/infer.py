"""Infer: from a laboratory record to the parameters of a problem, by full runs with inertia and waves."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np

from stickslip.extensions.inference.certainty.certainty import Certainty, Profile, certainty_of, profile_of, unknown
from stickslip.extensions.inference.certainty.directions import IDLE
from stickslip.extensions.inference.certainty.drifting import (
    TRENDS,
    Offer,
    lacking,
    needed,
    offered,
    said,
    with_number,
    without_number,
)
from stickslip.extensions.inference.certainty.kept_walk import KeptWalk
from stickslip.extensions.inference.certainty.sampling import MOST_SAMPLES, emcee, sample
from stickslip.extensions.inference.certainty.unresolved import unresolved
from stickslip.extensions.inference.fit.asides import with_servo
from stickslip.extensions.inference.fit.asked import FITTED_KINDS
from stickslip.extensions.inference.fit.by_features import FeatureModel, by_features, scatter_of
from stickslip.extensions.inference.fit.estimate import Estimate, estimate, windows_of
from stickslip.extensions.inference.fit.event_part import are_tables, parts_of_events
from stickslip.extensions.inference.fit.free import LOAD, Free, read_free, with_scale
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import Part, first_sizes, share_of, shortened
from stickslip.extensions.inference.fit.progress import OutOfTime, SearchProgress, Tell
from stickslip.extensions.inference.fit.search import COMPETES
from stickslip.extensions.inference.fit.setup import (
    at_rests,
    evenly,
    hints_of,
    own_of,
    parts_of,
    scales_of,
    with_parts,
)
from stickslip.extensions.inference.fit.starting import with_starts
from stickslip.extensions.inference.inference import Inference
from stickslip.extensions.inference.of_record import takes_fields
from stickslip.extensions.inference.record.noise import LOSSES
from stickslip.extensions.inference.record.record import Record
from stickslip.extensions.inference.record.resample import MOST_FITTED, resampled
from stickslip.extensions.inference.words import WORDS, Wishes
from stickslip.foundation.arguments import as_path, check_whole, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.locks import held
from stickslip.foundation.quantities import Quantity
from stickslip.problem import PRESSING, Problem, read_option
from stickslip.problem.scenarios import read_problem
from stickslip.run import telling

WAYS = ("samples", "features")
"""Data to fit: each sample of a record, or features of its slip events."""
NORMALS = ("problem", "record")
"""Where the normal load of the runs comes from."""
TOLD_APART = {"problem", "record", "free", "progress"}
"""Arguments that are not among the options that a result names: it tells them in other ways."""
MOST_PARTS, MOST_SEARCHED = 24, 8
"""Largest number of parts between rests to fit, and of those in the first search."""
LEAST_FITTED = 2000
"""A part with at most this many samples is fitted as it is, however many parts there are."""
TIME_OF_RECORD = Quantity("s", "time of the record")
WEIGHT = Quantity("1", "exponent of the weight of samples after a change of the pull rate", at_least=0.0)
LIMIT = Quantity("s", "processor time after which the search ends", above=0.0)
TIME_OF_SEARCH = 600.0
"""Default processor time (s) of a search."""


def check(wishes: Wishes) -> None:
    """Raise InputError for options of `infer` that are out of range."""
    for name, allowed in (("loss", LOSSES), ("by", WAYS)):
        _check_word(wishes, name, allowed)
    if wishes.by == "features" and wishes.parts is not None:
        raise InputError("infer: by='features' and parts='rests' are two ways to fit stick-slip: choose one")
    if wishes.parts not in (None, "rests"):
        raise InputError(f"infer: parts must be 'rests' or left out, got {shown(wishes.parts)}")
    if wishes.windows and (wishes.parts is not None or wishes.by == "features"):
        raise InputError("infer: windows are of records that are fitted as a whole: leave out parts='rests' and by='features'")
    for name, allowed in (("normal", NORMALS), ("trend", TRENDS)):
        _check_word(wishes, name, allowed)
    WEIGHT.check("infer", "weight", wishes.weight)
    _progress(wishes, lambda text: None)
    for name, least, most in (("starts", 1, 1000), ("samples", 0, MOST_SAMPLES), ("seed", 0, 2**32 - 1)):
        check_whole(f"infer: {name}", getattr(wishes, name), least, most)
    if wishes.samples:
        emcee()  # a fit is not thrown away because a library is missing
    elif wishes.checkpoint is not None:
        raise InputError("infer: checkpoint is of the samples that are drawn: ask for some with samples=, or leave it out")
    KeptWalk(_file(wishes)).check()
    read_option("rtol", wishes.rtol, "infer")


def _check_word(wishes: Wishes, name: str, allowed: Collection[str]) -> None:
    """Raise InputError unless an option is one of the words that it may be."""
    if (word := getattr(wishes, name)) not in allowed:
        raise InputError(f"infer: {name} {ascii(word)[:40]} is unknown; {nearest(str(word), allowed)}")


def _progress(wishes: Wishes, tell: Tell) -> SearchProgress:
    """Return the progress of the search, which ends when its time is over. Raises InputError for a time that is none."""
    return SearchProgress(tell, TIME_OF_SEARCH if wishes.max_time is None else LIMIT.check("infer", "max_time", wishes.max_time))


def _file(wishes: Wishes) -> Path | None:
    """Return the file of the samples. Raises InputError for what names no file."""
    return None if wishes.checkpoint is None else as_path("infer: checkpoint", wishes.checkpoint)


def _alone(wishes: Wishes) -> AbstractContextManager[None]:
    """Reserve the file of the samples against other processes. Raises InputError if another one writes into it."""
    if (file := _file(wishes)) is None:
        return nullcontext()
    return held(file, f"infer: checkpoint {file}: another inference is writing into it")


@takes_fields(WORDS, Wishes)
def infer(wishes: Wishes) -> Inference:
    """Fit the numbers of a problem to a laboratory record, by full runs, and find how well the record determines them.

    Parameters
    ----------
    {options}

    Returns
    -------
    Inference
        The best numbers with intervals, the best problem, and what the record does not determine. After Ctrl-C or `max_time`, it
        holds the best numbers so far.

    Raises
    ------
    InputError
        If the record or an option cannot be used, or no run succeeds; the message is one line with the cure.
    KeyboardInterrupt
        If the user presses Ctrl-C before a run has succeeded.

    Notes
    -----
    Least squares over full runs; positive numbers are searched on a logarithmic scale. The size of the residuals is then estimated
    and, by restricted maximum likelihood, their correlation time. The 95 % intervals allow for this correlation, and for residuals
    that are largest at the samples that count most, as those of a slightly wrong model (sandwich covariance). A misfit is reported
    as a misfit. The estimated noise affects the best numbers only through the weights of several quantities and of priors.

    See Also
    --------
    stickslip.studies.Record : read a record and look at it first.
    stickslip.friction.Fit : fit a law to points of friction against slip or slip rate.

    Examples
    --------
    >>> import stickslip as ss
    >>> import numpy as np
    >>> scenario = ss.load_scenario("velocity-steps-block")
    >>> time = np.linspace(0.0, 400.0, 801)
    >>> run = ss.simulate(scenario)
    >>> noise = 3e-4 * np.random.default_rng(1).standard_normal(len(time))
    >>> record = {"time (s)": time, "mu": run.traction(time) / scenario.problem.normal + noise}
    >>> found = ss.studies.infer(scenario, record, ["friction.a", "friction.b"], starts=1)
    >>> print(found.table[["low", "high"]].rename_axis(None).round(4).to_string())
                   low    high
    friction.a  0.0099  0.0101
    friction.b  0.0129  0.0131
    """
    check(wishes)
    given = read_problem("infer", wishes.problem)
    records = _records(wishes)
    observed = wishes.observe if wishes.by == "samples" else None
    _check_normal(given, wishes)
    if are_tables(records, wishes):
        recorded, notes = parts_of_events(given, records, wishes.start, wishes.sensor)
    else:
        recorded, notes = parts_of(given, records, observed, wishes.start, wishes.sensor, pressed=wishes.normal == "record")
    whole = recorded
    if wishes.parts == "rests":
        between = [piece for part in whole for piece in at_rests(part)]
        whole = evenly(between, MOST_PARTS)
        notes.append(f"{len(whole)} parts between rests, each with a run of its own")
        if len(whole) < len(between):
            notes[-1] += f", evenly spread among {len(between)}; by features all of them are fitted, with their scatter"
    whole, notes = (whole, notes) if whole[0].record.shear_of_events else _resampled(whole, notes)
    share = share_of(wishes.held_out, whole)
    fitted = shortened(whole, share)
    if wishes.by == "features":
        fitted, _ = by_features(fitted, wishes.observe)
        whole, told = by_features(whole, wishes.observe)
        notes += told
    model, offer, told = _begun(given, fitted, recorded, wishes)
    notes += told
    notes += FITTED_KINDS[given.body.structure].rounded_times(given.body, [one.name for one in model.free])
    doubts = [note for note in notes if note.endswith("?")]
    with telling(wishes.progress, "infer") as tell:
        for doubt in doubts:
            tell(doubt)
        try:
            found = _inferred(model, tuple(whole), wishes, tell, offer)
        except OutOfTime as stop:
            raise InputError(f"infer: no run has succeeded: {stop}; give other values or bounds") from None
        except InputError as error:  # a unit or a sign may be why no run succeeds, or motion that is given and not to be found
            raise InputError("; ".join([str(error), *doubts, *_along_motion(records)])) from None
    asked = {name: value for name, value in vars(wishes).items() if name not in TOLD_APART and value not in (None, False)}
    return replace(found, about=(*found.about, *notes), asked=asked)


def _along_motion(records: Sequence[Record]) -> list[str]:
    """Return the cure if records have measured motion and no load point."""
    moved = all(not {"slip_rate", "slip"}.isdisjoint(one.measured) for one in records)
    undriven = all(one.load_point is None and one.load_rate is None for one in records)
    cure = "a law along the measured motion, without body and spring, is found by `stickslip identify`"
    return [cure] if moved and undriven else []


def _check_normal(problem: Problem, wishes: Wishes) -> None:
    """Raise InputError for options that a normal load that varies excludes."""
    from_record = wishes.normal == "record"
    if wishes.by == "features" and (from_record or problem.normal_varies):
        raise InputError("infer: by='features' compares events under one normal load: fit samples, under one that varies")
    cut = "parts='rests'" if wishes.parts is not None else "windows=True" if wishes.windows else ""
    if cut and problem.normal_varies and not from_record:
        raise InputError(
            f"infer: {cut} begins runs later than the problem's normal_load does: give it in the record (normal='record')"
        )
    for name in _names(wishes.free):
        if from_record and name.rpartition(".")[2] in (PRESSING, "normal_stress", "normal_force"):
            raise InputError(f"infer: {name} cannot be free where the record gives the normal load (normal='record')")


def _names(free: Sequence[str] | str) -> list[str]:
    """Return the names of free numbers as they were typed."""
    return [one.strip() for one in (free.split(",") if isinstance(free, str) else free) if one.strip()]


def _resampled(parts: list[Part], notes: list[str]) -> tuple[list[Part], list[str]]:
    """Return the parts with a manageable number of samples, and the notes with what was done."""
    found, most = [], max(MOST_FITTED // len(parts), LEAST_FITTED)
    for part in parts:
        record, told = resampled(part.record, most)
        found.append(replace(part, record=record))
        notes = [*notes, *told]
    return found, notes


def _records(wishes: Wishes) -> list[Record]:
    source, times = wishes.record, {"begin": wishes.begin, "end": wishes.end}
    sources = source if isinstance(source, list | tuple) else [source]
    if not sources:
        raise InputError("infer: record must be at least one record, got none")
    begin, end = (None if value is None else TIME_OF_RECORD.check("infer", name, value) for name, value in times.items())
    return [Record.read(one, begin, end) for one in sources]


def _model(problem: Problem, parts: list[Part], names: Sequence[str] | str, wishes: Wishes) -> Model:
    chosen = read_free(
        problem, names, hints_of(problem, parts[0]), bounds=wishes.bounds, priors=wishes.priors, start=wishes.begin_at
    )
    chosen = with_servo(with_scale(chosen, scales_of(parts[0], problem)), parts)
    own = list[Free]()
    if wishes.parts == "rests":
        own = own_of(problem, parts, wishes.each)
    elif wishes.by == "samples" and all(part.start == "record" for part in parts):
        own = own_of(problem, parts, [LOAD])  # the first samples give the load only to within their noise
    own = [one for one in own if one.name not in {shared.name for shared in chosen}]
    kind = FeatureModel if wishes.by == "features" else Model
    sizes = scatter_of(parts) if wishes.by == "features" else first_sizes(parts)
    model = kind(problem, tuple(parts), (*chosen, *own), wishes.rtol, sizes, weight=wishes.weight)
    if wishes.by == "features" and sum(len(part.observed) for part in parts) < len(chosen):
        names = ", ".join(parts[0].observed)
        raise InputError(f"infer: {names} cannot determine {len(chosen)} numbers: free fewer of them, or record slip too")
    if model.samples <= len(chosen):
        raise InputError(f"infer: {model.samples} samples cannot determine {len(chosen)} numbers: free fewer of them")
    return model


def _begun(problem: Problem, parts: list[Part], recorded: list[Part], wishes: Wishes) -> tuple[Model, Offer | None, list[str]]:
    """Return the model where the search begins, a free number of it that nobody asked for, and sentences on the start."""
    model, offer, drift = _model(problem, parts, wishes.free, wishes), None, None
    if wishes.by == "samples" and wishes.parts is None:
        offer, drift = offered(problem, parts, model.free, wishes.trend)
    if offer is not None:
        model = _model(problem, parts, [*_names(wishes.free), offer.name], wishes)
    shared = [one for one in model.free if one.part is None]
    untold = "" if offer is None else offer.name
    begun, notes = with_starts(shared, problem, recorded, wishes.begin_at or (), drift, untold=untold)
    return model.with_(free=(*begun, *(one for one in model.free if one.part is not None))), offer, notes


def _inferred(model: Model, whole: tuple[Part, ...], wishes: Wishes, tell: Tell, offer: Offer | None) -> Inference:
    """Return the result with all that the user asked for; after Ctrl-C, without the parts that were not finished.

    `offer` is a free number that nobody asked for, which stays if the fit needs it.
    """
    tell = progress = _progress(wishes, tell)
    model = model.with_(ran=progress.run, tried=progress.tried)
    if offer is not None:
        tell(f"{offer.why}: {offer.name} is free, too")
    found = _estimated(model, wishes, tell)
    sure, profiles, windows = unknown(found), list[Profile](), None
    walk, finished, ended, words, between = None, found.finished, found.ended, list[str](), list[str]()
    try:
        tell("what the record determines")
        sure = certainty_of(found)
        if finished and wishes.trend == "auto" and wishes.by == "samples" and wishes.parts is None:
            found, sure, words = _drifting(found, sure, offer, wishes, tell)
        found = _idle_as_given(found, sure)
        between = unresolved(found.model, found.searched) if finished else between
        if wishes.max_time is None:
            progress.limit = math.inf  # how long the rest takes is known beforehand
        if finished and wishes.windows:
            windows = windows_of(found, tell)
        if finished and wishes.profiles:
            shared = [i for i, one in enumerate(found.model.free) if one.part is None]
            profiles.extend(profile_of(found, sure, i, tell) for i in shared)
        if finished and wishes.samples:
            with _alone(wishes):
                walk = sample(found, sure, wishes.samples, tell, seed=wishes.seed, keep=KeptWalk(_file(wishes)))
            finished = not walk.stopped
    except KeyboardInterrupt as stop:
        finished, ended = False, str(stop)
    found = replace(found, finished=finished, ended=ended)
    return Inference(found, sure, whole, tuple(words), tuple(profiles), walk, windows, unresolved=tuple(between))


def _drifting(
    found: Estimate, sure: Certainty, offer: Offer | None, wishes: Wishes, tell: Tell
) -> tuple[Estimate, Certainty, list[str]]:
    """Return a fit with the drifts that it lacks, and without those offered that it does not need, and sentences on them."""
    offers = [] if offer is None else [offer]
    for _ in range(2):  # with slip, and with time
        if (lacked := lacking(found, sure.slopes)) is None:
            break
        tell(f"{lacked.why}: {lacked.name} is free, too")
        more = _from_its_end(with_number(found, lacked.name), found, wishes, tell)
        more_sure = certainty_of(more)
        if not more.finished or not needed(more, more_sure, lacked.name):
            break
        found, sure, offers = more, more_sure, [*offers, lacked]
    for one in list(offers):
        if not needed(found, sure, one.name):
            fewer = _from_its_end(without_number(found, one.name), found, wishes, tell)
            if fewer.finished:
                found, sure = fewer, certainty_of(fewer)
                offers.remove(one)
    return found, sure, [text for one in offers for text in said(one, found, sure)]


def _from_its_end(model: Model, end: Estimate, wishes: Wishes, tell: Tell) -> Estimate:
    """Return the best fit of a model that begins where another search has ended, with the starts of that search."""
    found = _estimated(model, replace(wishes, starts=1), tell)
    first = {one.label: one for one in end.model.free}
    return replace(found, model=found.model.with_(free=tuple(first.get(one.label, one) for one in found.model.free)))


def _estimated(model: Model, wishes: Wishes, tell: Tell) -> Estimate:
    """Return the best fit; of many parts, a few are searched first."""
    if len(model.parts) <= MOST_SEARCHED:
        return estimate(model, wishes.starts, wishes.loss, wishes.seed, tell)
    few = estimate(with_parts(model, MOST_SEARCHED), wishes.starts, wishes.loss, wishes.seed, tell)

    def with_shared(searched: Floats) -> tuple[Free, ...]:
        values = {one.label: value for one, value in zip(few.model.free, few.model.values(searched), strict=True)}
        return tuple(one if one.part is not None else replace(one, start=values[one.label], given=None) for one in model.free)

    begun = model.with_(free=with_shared(few.searched))
    if not few.finished:
        return Estimate(model, begun.begin, finished=False, loss=wishes.loss)
    tell(f"all {len(model.parts)} parts")
    found = estimate(begun, 1, wishes.loss, wishes.seed, tell)
    others = [begun.with_(free=with_shared(x)).begin for x in few.others]
    others = [np.append(x, found.searched[len(x) :]) for x in others]
    others = [x for x in others if found.cost(x) < found.cost(found.searched) + COMPETES]
    first = {one.label: one for one in model.free}  # with the starts of the search
    free = tuple(first.get(one.label, one) for one in found.model.free)
    return replace(found, model=found.model.with_(free=free), others=tuple(others))


def _idle_as_given(found: Estimate, sure: Certainty) -> Estimate:
    """Return the best fit with the given values of numbers without influence."""
    idle = np.linalg.norm(sure.slopes, axis=0) < IDLE
    given = np.where(idle, found.model.begin, found.searched)
    kept = idle.any() and found.cost(given) < found.cost(found.searched) + IDLE
    return replace(found, searched=given) if kept else found

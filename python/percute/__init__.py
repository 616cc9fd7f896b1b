"""Simulation of impacts of bodies that are elastic or yield, with an estimate of its error.

State a `Problem` on a `Mesh`, `simulate` it, and `estimate` the error of the simulation::

    import percute as pc

    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=20, ny=16)
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)
    problem = pc.Problem(mesh, material=material, obstacles=[plane], initial_velocity=(400, -400))
    estimate = pc.estimate(pc.simulate(problem, end=13e-6, courant=0.9))
    estimate.relative_sup

All quantities are in SI units. Numbers in brackets, like eq. [14], are equations of Louf, Gallimard and Pelle, *Un estimateur
d'erreur en relation de comportement pour les problèmes d'impact*.
"""

from percute import exact
from percute._percute import Progress, __version__
from percute.adapting import Adaptation, adapt
from percute.balance import Balance
from percute.bodies import Body, Interface
from percute.contact import Contact
from percute.contact_results import ContactStatus, Resultants
from percute.deformation import (
    BodyDeformation,
    ContactPeak,
    Deformation,
    ElasticMargin,
    ElementPlace,
    Extreme,
    MaterialStress,
    Nearest,
    OverallYielding,
    PlasticFlow,
    PoorElement,
    Yielding,
)
from percute.errors import (
    EstimateError,
    ExistingFileError,
    FileFormatError,
    InputError,
    InputWarning,
    MeshWarning,
    MissingFileError,
    PercuteError,
    SimulationError,
    SimulationWarning,
    StorageError,
)
from percute.estimating import estimate
from percute.estimation import Estimate
from percute.files import open, resume, run
from percute.history import History
from percute.impacts import BodyMotion, Impacts, InterfaceRebound, NonMatchingEstimate
from percute.iterations import Iterations
from percute.mesh import Mesh
from percute.names import name_arguments as _name_arguments
from percute.problem import Problem
from percute.rebound import NextTouch, Rebound
from percute.records import ElementMap, OverTime, Parts, Separation, Sources, SourcesOverTime, WorstElement
from percute.rigid_motion import RigidMotion
from percute.simulation import simulate, true_errors
from percute.statement import BodyForce, Elastic, Plane, Support, Traction
from percute.sweeping import Sweep, sweep
from percute.true_error import Effectivity, TrueError
from percute.verifying import Convergence, Verification, verify

__all__ = [
    "Adaptation",
    "Balance",
    "Body",
    "BodyDeformation",
    "BodyForce",
    "BodyMotion",
    "Contact",
    "ContactPeak",
    "ContactStatus",
    "Convergence",
    "Deformation",
    "Effectivity",
    "Elastic",
    "ElasticMargin",
    "ElementMap",
    "ElementPlace",
    "Estimate",
    "EstimateError",
    "ExistingFileError",
    "Extreme",
    "FileFormatError",
    "History",
    "Impacts",
    "InputError",
    "InputWarning",
    "Interface",
    "Iterations",
    "InterfaceRebound",
    "MaterialStress",
    "Mesh",
    "MeshWarning",
    "MissingFileError",
    "Nearest",
    "NextTouch",
    "OverTime",
    "OverallYielding",
    "Parts",
    "PercuteError",
    "Plane",
    "PlasticFlow",
    "PoorElement",
    "Problem",
    "Progress",
    "Rebound",
    "RigidMotion",
    "Resultants",
    "Separation",
    "SimulationError",
    "SimulationWarning",
    "NonMatchingEstimate",
    "Sources",
    "SourcesOverTime",
    "StorageError",
    "Support",
    "Sweep",
    "Traction",
    "TrueError",
    "Verification",
    "WorstElement",
    "Yielding",
    "__version__",
    "adapt",
    "estimate",
    "exact",
    "open",
    "resume",
    "run",
    "simulate",
    "sweep",
    "true_errors",
    "verify",
]

_name_arguments("percute.exact")
_name_arguments("percute")


def __dir__() -> list[str]:
    """Give the public names only."""
    return sorted(__all__)

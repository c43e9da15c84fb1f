"""What workers call with scenes: a module that is quick to import in another process."""

import os

import ropedyn as rd

ROPE = rd.Rope(1.0, 0.1, bending_stiffness=1.0)


class Unlucky(Exception):
    """An exception that pickles and cannot be unpickled."""

    def __init__(self, number, reason):
        super().__init__(f"number {number} {reason}")


def frequencies(scene):
    return scene.compile().modes(3).frequency


def reciprocal(number):
    if number == 3:
        raise Unlucky(3, "has bad luck")
    return 1 / number


def strange(number):
    if number == 5:
        return lambda: number  # no process can send it
    if number == 7:
        os._exit(1)
    return number


def itself(anything):
    return anything


def interrupted(number):
    if number == 2:
        raise KeyboardInterrupt
    return number

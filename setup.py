"""Called by catkin_python_setup() in CMakeLists.txt. Do not call it by hand."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['organ_collision'], package_dir={'': 'python'}))

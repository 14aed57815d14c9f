import pytest

import patina


@pytest.fixture(scope="session")
def device():
    return patina.Device()
